"""What an assistant does to a town as the share of cars that have it grows.

adoption  what is run, and what comes of it
page      its report
"""
