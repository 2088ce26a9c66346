"""Checks one stored episode: its row against the plan, its trace, and the verdict on its stored moments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import ActionType, Feedback, FeedbackCode, Json
from automotive_cosim.contracts.given import Hearing
from automotive_cosim.drives.families import family_named
from automotive_cosim.episode.specification import ROUNDING_S, End
from automotive_cosim.errors import CosimError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import opened
from automotive_cosim.interface.trace import SAID, SELDOM, Step, element, plain, sha256
from automotive_cosim.measures.following import nearest_s
from automotive_cosim.publish.drives import PLANNED as DRIVE_PLANNED
from automotive_cosim.publish.drives import UNJUDGED as DRIVE_UNJUDGED
from automotive_cosim.publish.drives import drive_problems
from automotive_cosim.publish.problems import ROWS, Problem, attempt_problems, differences
from automotive_cosim.run.coverage import is_outdated
from automotive_cosim.run.drive import DriveSetup
from automotive_cosim.run.episode import IN_RESULT, EpisodeSetup
from automotive_cosim.run.figures import alerts, driver_load, pixel_taps, questioned
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.moments import Judged, judged_file, read_judged
from automotive_cosim.run.regrade import judged_again
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, PartsHeld, TrialRow
from automotive_cosim.run.store import read_trace, trace_file
from automotive_cosim.run.trial import TrialSetup
from automotive_cosim.scenarios import shipped
from automotive_cosim.tasking.dialogue import dialogue, is_lost, questions
from automotive_cosim.tasking.instance import Instance, phrased
from automotive_cosim.voice.cabin import level_db, voices

STEP_BYTES, SPARE_STEPS = 2**20, 4
"""Bytes that a step may have in a trace, on average: a full screen has 40 kB, a question to a model 100 kB."""
SECOND_BYTES, SPARE_S = 2**15, 120.0
"""The same for a second of an episode's moments, of which a dense city has 10 kB, and of a drive's trace and facts,
which have 1 kB. The last answer may take an episode beyond its limit."""
PLANNED = (
    "task", "half", "pair", "dimension", "module", "basis", "suite", "tags", "skills", "ability", "declines",
    "agent", "model", "conditions", "seed", "repeat", "split",
)  # fmt: skip
"""Fields of a row that the plan and the catalogue determine."""
FROM_MOMENTS = (
    "local_time", "traffic", "signals", "weather", "gps", "connectivity", "context", "events",
    "awareness", "cabin_db",
)  # fmt: skip
"""Fields of a step that follow from the stored moments."""
STEP = frozenset(
    {"step", "time_s", *FROM_MOMENTS, "elements", "action", "feedback", "thought_s", "thought", "stages"}
) - {*SELDOM}
UNJUDGED = ("success", "reward", "parts", "goal_s", "reason_fits")
"""Fields of a row that an episode without a verdict leaves at their defaults."""
BY_REPLAY = frozenset(
    {
        f"{ROWS} speed_compliance", f"{ROWS} min_time_to_collision_s", f"{ROWS} measures", f"{ROWS} exposure",
        "result path", "result timeline", "result violations", "result estimates", "result notes",
        "step feedback", "step said", "step heard", "step thought", "step stages",
    }
)  # fmt: skip
"""Fields that only a replay can check; thoughts and stages, of an agent of this package that asks a model."""
ON_TRUST = frozenset(
    {
        f"{ROWS} wall_seconds", f"{ROWS} failed_attempts", "result without",
    }
)  # fmt: skip
"""Fields that neither the bundle nor a replay can check."""


def check_trial(folder: Path, job: TrialSetup, row: TrialRow) -> tuple[Problem, ...]:
    """Everything that is wrong with a trial.

    Args:
        folder: an evaluation's or an unpacked bundle's."""
    try:
        if large := _too_large(folder, job):
            return (large,)
        return tuple(_problems(folder, job, row))
    except (
        CosimError, OSError, LookupError, TypeError, ValueError, AttributeError, ArithmeticError, RecursionError,
        MemoryError,
    ) as error:  # fmt: skip
        why = str(error) if isinstance(error, CosimError) else f"{type(error).__name__}: {error}"
        return (Problem(f"traces/{row.id}", "", f"cannot be checked: {why}"),)


def _too_large(folder: Path, job: TrialSetup) -> Problem | None:
    """The first file of a trial that is larger than its plan allows."""
    if not isinstance(job, EpisodeSetup):
        assert isinstance(job, DriveSetup)
        of_trace = of_moments = SECOND_BYTES * (family_named(job.family).draw(job.seed).duration_s + SPARE_S)
    else:
        of_trace = STEP_BYTES * ((job.max_steps or job.entry.max_steps) + SPARE_STEPS)
        of_moments = SECOND_BYTES * (job.limits.sim_s + SPARE_S)
    for path, most in ((trace_file(folder, job.id), of_trace), (judged_file(folder, job.id), of_moments)):
        if path.is_file():
            left = most
            with opened(path) as file:
                while left >= 0 and (chunk := file.read(bounds.CHUNK_BYTES)):
                    left -= len(chunk)
            if left < 0:
                where = path.relative_to(folder).as_posix()
                return Problem(where, "", f"unpacks to over {most / 1e6:.0f} MB, which the plan does not allow")
    return None


def _problems(folder: Path, job: TrialSetup, row: TrialRow) -> Iterator[Problem]:
    planned = job.planned()
    if type(row) is not type(planned):
        yield Problem(ROWS, row.id, "is of another kind than the plan says")
        return
    is_drive, told, expected = isinstance(row, DriveTrialRow), as_json(row), as_json(planned)
    yield from differences(ROWS, row.id, told, expected, DRIVE_PLANNED if is_drive else PLANNED, "the plan")
    if isinstance(row, EpisodeRow) and is_outdated(row):
        yield Problem(ROWS, f"{row.id} half_digest", "is not that of the half, which has changed since")
    yield from attempt_problems(row)
    if isinstance(job, EpisodeSetup) and isinstance(row, EpisodeRow):
        if job.in_scenario in _shipped() and row.scenario != job.in_scenario:
            yield Problem(ROWS, f"{row.id} scenario", f"is {row.scenario!r}, but {job.in_scenario!r} by the plan")
        if row.traffic_seed not in (None, job.seed, *job.spare_traffic):
            yield Problem(ROWS, f"{row.id} traffic_seed", f"is {row.traffic_seed}, which the plan does not have")
    if row.outcome is None:
        yield from differences(ROWS, row.id, told, expected, DRIVE_UNJUDGED if is_drive else UNJUDGED, "its error")
        if row.error is None or row.error_kind is None or row.end is not End.ERROR:
            yield Problem(ROWS, row.id, f"has neither a {'judgement' if is_drive else 'verdict'} nor an error")
    elif isinstance(row, DriveTrialRow):
        yield from drive_problems(folder, row, told)
    elif row.end is not End.AGENT_FAILED or trace_file(folder, row.id).is_file():
        assert isinstance(job, EpisodeSetup)
        assert isinstance(row, EpisodeRow)
        yield from _judged_problems(folder, job, row, told)
    elif row.outcome or row.agent_error is None:
        yield Problem(ROWS, row.id, "has a verdict without a trace")


def _malformed(row: EpisodeRow, steps: Sequence[Json]) -> Json:
    """The fields of a row about answers that were no action, by its trace; earlier rows have none."""
    told = [each["feedback"] for each in steps]
    refused = [each["text"] for each in told if each["code"] == FeedbackCode.MALFORMED]
    return {} if row.malformed is None else {"malformed": len(refused), "malformed_why": next(iter(refused), "")}


def _judged_problems(folder: Path, job: EpisodeSetup, row: EpisodeRow, told: Json) -> Iterator[Problem]:
    *steps, last = read_trace(folder, row.id)
    judged = read_judged(folder, row.id, Judged)
    file, result = trace_file(folder, row.id).relative_to(folder).as_posix(), dict(last["result"])
    if "untouched_drive" in result:  # its name in older traces
        result["baseline_drive"] = result.pop("untouched_drive")
    yield from _step_problems(file, steps, judged, job.conditions.hear)
    source = judged_file(folder, row.id).relative_to(folder).as_posix()
    verdict = judged_again(row, judged)
    hand_over, end = judged.trace[0], judged.trace[-1]
    prompts = [stage["reply"]["tokens_in"] for step in steps for stage in step["stages"] if stage["reply"]]
    seen = _steps(steps, judged)
    load, taps = driver_load(seen), pixel_taps(seen)
    expected: Json = {
        "success": verdict.success,
        "reward": float(verdict.success),
        "parts": asdict(PartsHeld.of(verdict)),
        "goal_s": verdict.goal_s,
        "reason_fits": verdict.reason_fits,
        "parameters": {name: plain(value) for name, value in judged.parameters.items()},
        "country": hand_over.context.country,
        "alerts": alerts(hand_over, end),
        **_questions(job, row, judged),
        "steps": len(steps) - 1,
        **_malformed(row, steps),
        "sim_seconds": round(end.time_s - hand_over.time_s, 3),
        "thought_s": round(sum(step["thought_s"] for step in steps), 1),
        "trace_sha256": sha256(steps),
        "interaction_s": load.interaction_s,
        "within_guideline": load.within_guideline,
        "taps": taps and asdict(taps),
        "prompt_tokens": prompts,
        "error": None,
        "error_kind": None,
    }
    yield from differences(ROWS, row.id, told, expected, expected, "its trace and the verdict on its moments")
    both = {"verdict": verdict.as_json(), "goal": judged.goal, "load": asdict(load)}
    yield from differences(file, "result", result, both, both, "the verdict on its moments")
    yield from differences(file, "result", result, told, (*IN_RESULT, "breaches"), f"its line in {ROWS}")
    yield from _end_problems(job, row, judged, len(steps) - 1)
    if row.end not in (End.OUT_OF_BUDGET, End.AGENT_FAILED) and row.tokens_in != sum(prompts):
        yield Problem(ROWS, f"{row.id} tokens_in", f"is {row.tokens_in}, but {sum(prompts)} by its trace")
    near = nearest_s(state for moment in judged.trace[1:] for state in moment.passed)
    if near is not None and (row.min_time_to_collision_s is None or row.min_time_to_collision_s > near):
        yield Problem(ROWS, f"{row.id} min_time_to_collision_s", f"is above {near} in {source}")
    if row.drive and row.drive.min_time_to_collision_s != row.min_time_to_collision_s:
        yield Problem(ROWS, f"{row.id} min_time_to_collision_s", "is not that of its drive")
    yield from _phrasing_problems(source, job, row, judged)


def _step_problems(file: str, steps: Sequence[Json], judged: Judged, hear: Hearing) -> Iterator[Problem]:
    """Problems of the steps, compared with their moments."""
    moments = {moment.time_s: moment for moment in judged.trace}
    for number, step in enumerate(steps):
        if step.keys() - {*SELDOM} != STEP or step["step"] != number:
            yield Problem(file, f"step {number}", "is missing, or has other fields")
            return
        moment = moments.get(step["time_s"])
        if moment is None:
            yield Problem(file, f"step {number} time_s", "matches no stored moment")
            continue
        spoken = voices(((each["time_s"], each.get(SAID, ())) for each in steps[:number]), moment.time_s)
        cabin_db = level_db(moment, spoken) if hear.is_by_ear else None
        expected = Step(number, moment, (), None, Feedback(FeedbackCode.NONE, ""), cabin_db=cabin_db).as_json()
        yield from differences(file, f"step {number}", step, expected, FROM_MOMENTS, "its stored moment")
    if [step["time_s"] for step in steps] != sorted(step["time_s"] for step in steps):
        yield Problem(file, "time_s", "the steps are not in order")
    if steps[0]["time_s"] != judged.trace[0].time_s or steps[0]["action"] is not None:
        yield Problem(file, "step 0", "is not the hand-over")
    action = None if steps[-1]["action"] is None else parse(steps[-1]["action"])
    declared = (action.goal_status, action.reason) if action else (None, None)
    if declared != (judged.declared, judged.reason):
        yield Problem(file, f"step {len(steps) - 1} action", "is not the judged declaration")
    if tuple(text for step in steps for text in _answers(step)) != judged.said:
        yield Problem(file, "action", "the answers are not the judged ones")


def _answers(step: Json) -> Iterator[str]:
    """What the agent said in a step, if the driver understood it."""
    action = step["action"]
    if (
        not is_lost(step.get(SAID, ()), (step["feedback"] or {}).get("text"))
        and isinstance(action, dict)
        and action.get("action_type") == ActionType.ANSWER
    ):
        yield str(action.get("text"))


def _questions(job: EpisodeSetup, row: EpisodeRow, judged: Judged) -> Json:
    """The row's fields about questions."""
    half = Instance(job.entry, row.half, judged.goal, judged.parameters, language=row.conditions.language).half
    texts = (asked["text"] for asked in questions(judged.trace[0], judged.trace[-1]))
    return questioned(dialogue(texts, half.topics, half.needed_topics, half.neutral))


def _end_problems(job: EpisodeSetup, row: EpisodeRow, judged: Judged, steps: int) -> Iterator[Problem]:
    """Problems with the end of the episode, compared with its moments."""
    last = judged.trace[-1]
    passed_s = last.time_s - judged.trace[0].time_s
    most_s = job.max_sim_s
    if last.driving.end is not None:
        legal = {End.DRIVE_ENDED}
    elif judged.declared is not None:
        legal = {End.DECLARED}
    elif steps >= (job.max_steps or job.entry.max_steps):
        legal = {End.OUT_OF_STEPS}
    elif most_s is not None and passed_s >= most_s - ROUNDING_S:
        legal = {End.OUT_OF_TIME}
    else:
        legal = {End.OUT_OF_BUDGET, End.AGENT_FAILED}
    if row.end not in legal or (row.end is End.AGENT_FAILED) != (row.agent_error is not None):
        yield Problem(ROWS, f"{row.id} end", f"is {row.end}, but {' or '.join(sorted(legal))} by its moments")


def _phrasing_problems(file: str, job: EpisodeSetup, row: EpisodeRow, judged: Judged) -> Iterator[Problem]:
    """Problems with the phrasing: it must be one of the task's, and held out or not as the row says."""
    said = phrased(job.entry, row.half, judged.parameters, row.conditions.language)
    if judged.goal not in said:
        yield Problem(file, "goal", f"is {judged.goal!r}, which is not a phrasing of {row.task}")
    elif row.held_out is not (judged.goal == said[-1]) or (job.held_out and not row.held_out):
        yield Problem(ROWS, f"{row.id} held_out", f"is {str(row.held_out).lower()}, but the phrasing is not")


def _steps(steps: Sequence[Json], judged: Judged) -> list[Step]:
    """The steps as they were while the episode ran, with the texts that the load on the driver depends on."""
    moments = {moment.time_s: moment for moment in judged.trace}
    return [
        Step(
            step["step"],
            moments[step["time_s"]],
            tuple(map(element, step["elements"])),
            None if step["action"] is None else parse(step["action"]),
            Feedback(FeedbackCode(step["feedback"]["code"]), step["feedback"]["text"]),
        )
        for step in steps
        if step["time_s"] in moments
    ]


@cache
def _shipped() -> frozenset[str]:
    return frozenset(shipped())
