"""The names that are loaded at first use, and where each is defined (``lazy``)."""

from automotive_cosim.agents.base import Agent, Learner, Privileged, Stage, StageName, Thinker
from automotive_cosim.agents.caller import Caller
from automotive_cosim.agents.human import Human
from automotive_cosim.agents.making import make_agent, model_of
from automotive_cosim.agents.model_agent import ModelAgent
from automotive_cosim.agents.native import FORMATS, NativeAgent, chosen
from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.agents.registry import ABOUT, AGENTS, MODELLED, NOT_RANKED, is_remote
from automotive_cosim.agents.settings import PROFILES, AgentPart, AgentSettings
from automotive_cosim.agents.trivial import AlwaysAlert, AlwaysAsk, NoOp, PressEverything, Random

__all__ = [
    "ABOUT",
    "AGENTS",
    "FORMATS",
    "MODELLED",
    "NOT_RANKED",
    "PROFILES",
    "Agent",
    "AgentPart",
    "AgentSettings",
    "AlwaysAlert",
    "AlwaysAsk",
    "Caller",
    "Human",
    "Learner",
    "ModelAgent",
    "NativeAgent",
    "NoOp",
    "Oracle",
    "PressEverything",
    "Privileged",
    "Random",
    "Stage",
    "StageName",
    "Thinker",
    "chosen",
    "is_remote",
    "make_agent",
    "model_of",
]
