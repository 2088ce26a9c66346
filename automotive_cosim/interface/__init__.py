"""What an agent sees and does.

observe   the part of a moment that an agent is given, by channel
controls  geo controls: the same instance with other information about place
spaces    observations and actions as gymnasium spaces
trace     the trace of an episode, step by step, and its hash
"""
