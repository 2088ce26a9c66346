"""Studies: what rerouting gains, from futures that leave the very same traffic.

plan       what is studied: scenario, departures, seeds, shares, news, policies
drive      one drive with its decision points, and the branches that leave it there
compare    two futures of one instant against each other
traffic    whether the traffic still flows, or is kept apart as gridlocked
driver     an agent at the cockpit decides
policies   who decides, and what came of it
batch      drives in parallel, resumed, until the interval is narrow enough
results    what is stored, read back, as data frames
intervals  means with bootstrap intervals over seeds
tables, charts, page    the report
"""
