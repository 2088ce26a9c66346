"""Drives: ten to thirty minutes at the cockpit, with events that an agent has to notice by itself.

script     everything that is drawn before a drive departs
staging    what can be staged, each kind with its look-alike
family     draws scripts from a seed
families/  the families over all scenarios
departure  a script -> a running co-simulation
events/    kinds of events, found on the drive itself
wakes      what wakes an agent that waits
session    an agent on a drive
timeline   the drive second by second, as data
judge      what became of each event, and what each act was
score      what that comes to
faults     what was missed, late or needless, one by one
watchers   the rule-perfect watcher, and trivial ones
reading    what the rule-perfect watcher reads from an observation
looks      what it then looks at
margins    from when on a rule is broken for certain
"""
