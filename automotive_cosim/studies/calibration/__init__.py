"""A scenario and hourly counts -> a demand that carries the counts when it is driven.

settings    what can be set
counts      reads counts, places of sites, travel times
capacity    what roads and signals carry at most
sites       site -> edge, and what is doubtful
driving     drives a demand, measures what passes
candidates  routes, and their shares before any count is known
fit         flows of routes, as near to those shares as the counts allow
search      fit and drive, until the simulation carries the counts
result      the figures; page: the same for readers
calibrate   all of it in order; writes the scenario
"""
