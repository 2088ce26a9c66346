"""The search for failures of an agent in a space of situations and conditions.

settings   how a space is searched
space      factors and their values, from a TOML file
samplers   what to try next
objective  by how much a trial passed or failed
hunt       tries, repeats failures and reduces them
findings   what a search has found: rates, bounds, coverage, failures in words
forecast   what a search will take before it runs
trying     runs points as trials of an evaluation that grows
page       report and regression plan
"""
