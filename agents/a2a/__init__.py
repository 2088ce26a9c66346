r"""Agents behind an address that speak A2A, as those of CAR-bench do: ``a2a:http://HOST:PORT``.

contract    what is said: parts of messages in both directions, without a transport
line        how it is said: the agent's card, and one message after the other (needs ``a2a-sdk``)
agent       the conversation as an agent of this project

user:   "System: ...\n\nUser: ..."    {"tools": [...]}     one context for each episode
agent:  "words", {"tool_calls": [...]}                    each call is a step
user:   {"tool_results": [...]}, or "words"               the situation as it is then
"""

from automotive_cosim.agents.a2a.agent import CHANNELS, A2AAgent

__all__ = ["CHANNELS", "A2AAgent"]
