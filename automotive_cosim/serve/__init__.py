"""``automotive-cosim serve``: runs, results, tasks and scenarios as pages in a browser.

records    finds recorded episodes and evaluations in the folders given, and reads nothing outside them
content    what the pages show of them, as plain values
catalogue  the same of tasks and scenarios
play       lets a person work the cockpit in real time
person     the person as the agent of an episode, and the screen that an act shows at once
played     keeps what people play as an evaluation, which every report reads
dealing    what a study deals to whom, in what order
study      a running study: seats, questions, export
observers  tells running studies that somebody observes them
server     answers a browser: token, host and origin checked, a fixed table of routes
static/    one page, one stylesheet, small scripts without a library; texts are only ever set as text
"""
