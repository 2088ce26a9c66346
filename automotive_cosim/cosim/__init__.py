"""The co-simulation: one car, its road, its place on earth and its cockpit, stepped together.

moment      the whole state at one instant
simulation  the step that couples traffic, place and cockpit
"""
