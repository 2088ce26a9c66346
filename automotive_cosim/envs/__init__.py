"""The gymnasium environments: thin adapters of ``episode``.

cockpit  ``AutomotiveCosim/Cockpit-v0``
flat     ``AutomotiveCosim/Flat-v0``, for reinforcement learning
"""
