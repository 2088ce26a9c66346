"""Doors: what other programs speak, each as a thin adapter of the service of episodes.

mcp            a server of the Model Context Protocol (extra ``doors``)
inspect_tasks  tasks for Inspect (extra ``harnesses``)
verifiers      a taskset for verifiers (extra ``harnesses``)
shared         one service for a whole process, and specifications from plain words
"""
