"""The co-simulation: one car, its road, its place on earth and its cockpit, stepped together.

moment      the whole state at one instant
car         the cockpit, receivers and navigation at one place and time
simulation  the step that couples traffic and car
"""
