"""The gymnasium environments: thin adapters of ``episode``.

cockpit  ``AutomotiveCosim/Cockpit-v0``
flat     ``AutomotiveCosim/Flat-v0``, for reinforcement learning
vector   many of either in one process, as ``gymnasium.make_vec`` makes them
pool     the warm simulations that all of them share
"""
