"""Routes of a demand from repeated simulation.

gap          how far a demand is from an equilibrium
equilibrium  routes on which nobody would do better alone
optimum      routes with a lower total travel time
settings     what can be set
"""
