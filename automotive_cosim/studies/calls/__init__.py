"""What a study calls in the process of a simulation (``traffic.running``): functions of what runs there.

accounts  what is read: the state of the traffic, the ego's consumption, how a future ended
ledger    keeps a record of all vehicles, and reads it
chance    other random numbers from here on
chosen    drives a day on which what is asked of each driver is known before
divert    sends other cars the ego's other way
flow      intervenes, and measures a network
"""
