"""Drives: ten to thirty minutes at the cockpit, with events that an agent has to notice by itself.

plan       everything that is drawn before a drive departs
staging    what can be staged, each kind with its bait
family     draws plans from a seed
families/  the families over all scenarios
departure  a plan -> a running co-simulation
"""
