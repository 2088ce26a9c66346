"""The names that are loaded at first use, and where each is defined (``lazy``)."""

from automotive_cosim.agents import Agent, make_agent
from automotive_cosim.contracts import Action, ActionType, Element, GoalStatus, Observation, Reason
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.envs.drive import DriveEnv
from automotive_cosim.envs.flat import FlatEnv
from automotive_cosim.envs.flat_drive import FlatDriveEnv
from automotive_cosim.errors import CosimError, InfrastructureError, UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.report.results import load_results
from automotive_cosim.run.batch import run_plan
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.plan import Plan, make_plan
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.trial import run_trial

__all__ = [
    "Action",
    "ActionType",
    "Agent",
    "Channel",
    "CockpitEnv",
    "CosimError",
    "DriveEnv",
    "Element",
    "EpisodeRow",
    "EpisodeSetup",
    "FlatDriveEnv",
    "FlatEnv",
    "GoalStatus",
    "InfrastructureError",
    "Observation",
    "Plan",
    "Reason",
    "UserError",
    "load_results",
    "make_agent",
    "make_plan",
    "run_plan",
    "run_trial",
]

__version__: str
