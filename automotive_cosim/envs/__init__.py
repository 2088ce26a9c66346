"""The gymnasium environments: thin adapters of ``episode``.

cockpit     ``AutomotiveCosim/Cockpit-v0``
drive       ``AutomotiveCosim/Drive-v0``
flat        ``AutomotiveCosim/Flat-v0``, tasks for reinforcement learning
flat_drive  ``AutomotiveCosim/FlatDrive-v0``, drives for reinforcement learning
sb3         the same behind Stable-Baselines3's ``VecEnv``
fleet       ``AutomotiveCosim/Fleet-v0``, drives of several cars in one traffic, for PettingZoo and as vector
vector      many of ``Cockpit-v0`` or ``Flat-v0`` in one process, as ``gymnasium.make_vec`` makes them
base        what all of them have
numbers     what the flat ones share
pool        the warm simulations that all of them share
"""
