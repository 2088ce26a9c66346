"""Many episodes at once, for agents that come from outside: start, observe, act, finish.

    start(spec) -> EpisodeTurn      act(id, action) -> EpisodeTurn ... until turn.end      finish(id) -> its outcome

episodes   the service: ids, a lock per episode, limits, expiry of idle ones
turn       what an agent is told after each step

An episode is one on a task, or whatever else can begin a session and say what came of it (``Startable``): a drive.

There is no transport in it; ``doors`` adapts it to protocols.
"""

from automotive_cosim.service.episodes import EpisodeService, ServiceLimits
from automotive_cosim.service.turn import EpisodeTurn

__all__ = ["EpisodeService", "EpisodeTurn", "ServiceLimits"]
