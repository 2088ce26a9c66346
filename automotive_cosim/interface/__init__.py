"""What an agent sees and does.

observe   what of a moment an agent is given, by channel
controls  the same instance with another input of place
spaces    observations and actions in gymnasium's terms
trace     what an episode was, step by step, and its hash
"""
