"""Doors: what other programs speak, each as a thin adapter of the service of episodes.

mcp            a server of the Model Context Protocol (extra ``mcp``)
inspect_tasks  tasks for Inspect (extra ``inspect``), with ``inspect_play``
openenv        an environment for OpenEnv (extra ``openenv``)
verifiers      a taskset for verifiers (extra ``verifiers``)
shared         one service for a whole process, and specifications from plain words
"""
