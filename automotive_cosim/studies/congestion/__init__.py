"""Congestion studies: the delay of a whole network before and after an intervention, in copies of the same traffic.

plan      what a study runs, and its interventions
rows      what is kept of every seed
outputs   reads SUMO's outputs
seed      one seed: the traffic without an intervention and with each
results   reads stored results, and the figures that traffic engineers use
tables, charts, maps, page    the report
"""
