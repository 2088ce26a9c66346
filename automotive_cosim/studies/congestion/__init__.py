"""Congestion studies: the delay of a whole network before and after a measure, from copies of identical traffic.

plan      what a study runs, and its measures
rows      what is kept of every seed
outputs   reads SUMO's outputs
seed      one seed: the traffic without a measure and with each
results   reads stored results, and the figures that traffic engineers use
tables, charts, maps, page    the report
"""
