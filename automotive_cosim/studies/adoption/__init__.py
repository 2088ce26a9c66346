"""What an assistant does to a town as the share of cars that have it grows.

adoption  what is run, and what comes of it
fleets    where its equipped cars drove, each with what was asked of its driver
page      its report, with a map of these cars and a page for each
served    what pages in a browser show of them, also while they drive
"""
