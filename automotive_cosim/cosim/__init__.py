"""The co-simulation: one car, its road, its place on earth and its cockpit, stepped together.

moment      the whole state at one instant
car         what cockpit, receivers and navigation make of the road
simulation  the step that couples traffic and car
"""
