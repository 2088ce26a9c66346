"""Collects what an evaluation keeps of an episode: a row, a trace, screenshots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import Json
from automotive_cosim.cosim.exposed import states_of, stretches
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import Episode
from automotive_cosim.measures import exposure, following_figures
from automotive_cosim.run.episode import EpisodeObserver, EpisodeResult
from automotive_cosim.run.episode_row import EpisodeRow, PartsHeld
from automotive_cosim.run.harm import overspeed
from automotive_cosim.run.jobs import EpisodeJob
from automotive_cosim.run.moments import Judged
from automotive_cosim.run.observer import Shot
from automotive_cosim.run.settings import Pictures
from automotive_cosim.run.taps import pixel_taps
from automotive_cosim.tasking.dialogue import Question

OVERSPEED_SCALE_MPS = 2.23
"""Mean overspeed at which compliance is zero, 5 mph: nuPlan's speed-limit metric (``max_overspeed_value``)."""
PICTURE_QUALITY = 85


class Collector(EpisodeObserver):
    """Collects data while an episode runs, and makes the row and the trace when it is over."""

    def __init__(self, pictures: Pictures) -> None:
        self._pictures = pictures
        self._episode: Episode | None = None
        self._moments: list[Moment] = []
        self._lines: list[Json] = []
        self._shown: list[bytes] = []

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Keeps the drive since the hand-over."""
        if self._episode is not None:
            self._moments.append(moment)

    def begun(self, session: Episode, shot: Shot) -> None:
        """Starts collecting: everything from the hand-over counts."""
        self._episode = session
        self._moments = [session.moments[0]]
        self.stepped(shot)

    def stepped(self, shot: Shot) -> None:
        """Keeps the step and, if it may be needed, its screenshot."""
        told = {"thought": shot.thought, "stages": [stage.as_json() for stage in shot.stages]}
        self._lines.append(shot.step.as_json() | told)
        if self._pictures is not Pictures.NONE:
            data = BytesIO()
            Image.fromarray(shot.screenshot).save(data, format="JPEG", quality=PICTURE_QUALITY, subsampling=0)
            self._shown.append(data.getvalue())

    @property
    def steps(self) -> list[Json]:
        """The steps so far."""
        return [*self._lines]

    def trace(self, result: EpisodeResult) -> list[Json]:
        """The steps, then the result; nothing if there was no hand-over."""
        return [*self._lines, {"result": result.as_json()}] if self._lines else []

    def judged(self) -> Judged | None:
        """The input of the verdict; None without a verdict."""
        episode = self._episode
        if episode is None or episode.verdict is None:
            return None
        last = episode.steps[-1].action
        return Judged(
            episode.instance.goal,
            episode.instance.parameters,
            last.goal_status if last else None,
            last.reason if last else None,
            tuple(episode.moments),
            episode.baseline_moments,
            episode.counterfactual,
            episode.instance.half.allowed_writes,
            episode.said,
        )

    def keeps_pictures_of(self, result: EpisodeResult) -> bool:
        """Whether this episode's pictures are to be kept."""
        return bool(self._shown) and not (self._pictures is Pictures.FAILURES and result.success)

    def keep_pictures(self, folder: Path) -> None:
        """Writes the screenshots."""
        folder.mkdir(parents=True, exist_ok=True)
        for number, data in enumerate(self._shown):
            (folder / f"step_{number:03d}.jpg").write_bytes(data)

    def row(self, job: EpisodeJob, result: EpisodeResult) -> EpisodeRow:
        """The episode's row, without the fields that the batch adds."""
        episode, judged, load = self._episode, result.verdict, result.load
        measured = following_figures(states_of(self._moments)) if self._moments else None
        return replace(
            job.planned(),
            scenario=result.scenario,
            parameters=None if episode is None else dict(episode.instance.parameters),
            traffic_seed=result.traffic_seed,
            country="" if episode is None else episode.moments[0].context.country,
            success=result.success,
            reward=result.reward,
            end=result.end,
            agent_error=result.agent_error,
            parts=PartsHeld.of(judged) if judged else None,
            breaches=result.breaches if judged else None,
            goal_s=judged.goal_s if judged else None,
            reason_fits=judged.reason_fits if judged else None,
            alerts=None if episode is None else alerts(episode.moments[0], episode.moments[-1]),
            **({} if episode is None else questioned(episode.questions)),
            steps=result.steps,
            malformed=None if episode is None else len(episode.malformed),
            malformed_why="" if episode is None else next(iter(episode.malformed), ""),
            sim_seconds=result.sim_seconds,
            thought_s=0.0 if episode is None else round(sum(step.thought_s for step in episode.steps), 1),
            speed_compliance=compliance(self._moments),
            min_time_to_collision_s=None if measured is None else measured.min_ttc_s,
            measures=measured,
            exposure=exposure(stretches(self._moments)),
            drive=result.drive,
            baseline_drive=result.baseline_drive,
            interaction_s=load.interaction_s if load else None,
            within_guideline=load.within_guideline if load else None,
            taps=None if episode is None else pixel_taps(episode.steps),
            prompt_tokens=tuple(
                stage["reply"]["tokens_in"] for line in self._lines for stage in line["stages"] if stage["reply"]
            ),
            tokens_in=result.tokens_in,
            tokens_out=result.tokens_out,
            cost_usd=result.cost_usd,
            held_out=result.held_out,
            trace_sha256=result.trace_sha256,
            error=result.error,
            error_kind=result.error_kind,
            model_seconds=result.model_seconds,
        )


def compliance(moments: Sequence[Moment]) -> float | None:
    """Speed-limit compliance: 1 without overspeed, 0 from a mean overspeed of 2.23 m/s.

    Args:
        moments: in order; the result is None if no limit binds in any of them, or no time passes.
    """
    over_m, whole_s = overspeed(moments)
    return None if whole_s == 0 else round(max(0.0, 1 - over_m / (OVERSPEED_SCALE_MPS * whole_s)), 6)


def questioned(questions: Sequence[Question]) -> dict[str, Any]:
    """The fields of a row about questions to the driver."""
    return {
        "questions": len(questions),
        "unneeded_questions": sum(not question.is_needed for question in questions),
        "question_s": sum(question.seconds for question in questions),
    }


def alerts(start: Moment, end: Moment) -> int:
    """Alerts that the agent gave between two moments of its drive."""
    return len(end.commands["alerts"]) - len(start.commands["alerts"])
