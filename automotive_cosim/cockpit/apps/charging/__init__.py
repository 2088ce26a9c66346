"""Charging: the battery, its charge limit and schedule, and stations nearby."""
