"""Drives: a watch of 10 to 30 minutes with many events, each judged by what could be known and done in time.

plan, families   what is driven, drawn from a seed
departure        puts the car on the road
events           kinds of events, found on the drive itself
watch            an agent's session on a drive: it waits, and what happens wakes it
judge, score     what became of each event and act, and what that comes to
watchers         reference and trivial watchers
"""
