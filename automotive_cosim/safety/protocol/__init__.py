"""Trials of an agent as told       the limits that were told, when, and how far off
evidence for the rows of a car's protocol, and the points of the protocol's own calculator.

evidence   which trials speak for which row
calculator runs the calculator in an environment of its own
calculate  what runs there
page       the page and its tables
"""
