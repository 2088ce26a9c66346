"""Advice from day to day until traffic settles.

days     the days of one share of advised drivers, and of the user equilibrium
page     the report
"""
