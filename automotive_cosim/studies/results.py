"""The results of a study, read back: its drives, its decisions, and what each policy made of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.errors import SetupError
from automotive_cosim.run.store import read_manifest, read_rows
from automotive_cosim.studies.compare import METRICS
from automotive_cosim.studies.plan import StudyPlan, make_study
from automotive_cosim.studies.policies import Policy, best, chosen, parse_policy

if TYPE_CHECKING:
    import pandas as pd

NOISE = 0.95
"""The noise floor is this quantile of what the placebos changed."""


@dataclass(frozen=True, slots=True)
class Study:
    """A study's folder, read."""

    folder: Path
    manifest: Json
    plan: StudyPlan
    rows: tuple[Json, ...]
    """One a drive, in the order of the plan."""

    @property
    def errors(self) -> tuple[Json, ...]:
        """Drives that the machinery broke."""
        return tuple(row for row in self.rows if row["error"] is not None)

    @property
    def decisions(self) -> tuple[Json, ...]:
        """Those that count, each with the names of its drive."""
        return tuple(each for each in all_decisions(self.rows) if not each["excluded"])

    @property
    def excluded(self) -> Counter[tuple[str, str]]:
        """How many drives and decisions are kept out of the averages, by what they are and why."""
        found: Counter[tuple[str, str]] = Counter()
        for row in self.rows:
            if row["excluded"]:
                found["drive", row["excluded"]] += 1
        for each in all_decisions(self.rows):
            if each["excluded"]:
                found["decision", each["excluded"]] += 1
        return found

    @property
    def choices(self) -> tuple[Json, ...]:
        """What every policy made of every decision with news of every age."""
        return tuple(choices(self.rows, self.plan.policies))

    def noise(self) -> Noise:
        """What a change that nobody would call one does."""
        return noise(self.decisions)


@dataclass(frozen=True, slots=True)
class Noise:
    """The noise floor: differences that a car 0.1 % faster somewhere makes."""

    placebos: int
    time_s: float
    """``NOISE`` of the placebos changed the ego's travel time by no more than this; gains up to it are ties."""
    others_s: float
    """Likewise for the sum over the others."""


def read_study(folder: Path) -> Study:
    """Reads a study's folder, a running one too.

    Raises:
        UserError: it is no study's, or is broken.
    """
    manifest = read_manifest(folder)
    plan = make_study(manifest["plan"])
    rows = read_rows(folder)
    return Study(folder, manifest, plan, tuple(rows[job.id] for job in plan.jobs() if job.id in rows))


def load_study(folder: Path | str) -> pd.DataFrame:
    """What every policy made of every decision as a data frame, a row a choice.

    Raises:
        UserError: it is no study's folder, or is broken.
        SetupError: pandas is not installed.
    """
    try:
        import pandas as pd
    except ImportError as error:
        raise SetupError("load_study needs pandas: pip install 'automotive-cosim[report]'") from error
    return pd.DataFrame(list(read_study(Path(folder)).choices))


def all_decisions(rows: Iterable[Json]) -> Iterator[Json]:
    """Of every drive, those that do not count too."""
    for row in rows:
        names = {name: row[name] for name in ("scenario", "share", "seed", "departure_s", "trip")}
        for number, decision in enumerate(row["decisions"]):
            yield names | decision | {"id": f"{row['id']}-{number}", "stay": row["stay"]}


def choices(rows: Iterable[Json], policies: Sequence[str]) -> Iterator[Json]:
    """The choice of each policy at each decision that counts, by news of each age, and what it gained."""
    for decision in all_decisions(rows):
        if decision["excluded"]:
            continue
        least_s = _gain(decision, best(decision), "time_s")
        for policy in map(parse_policy, policies):
            for news in decision["news"]:
                number = chosen(policy, decision, news["age_s"])
                others = None if number is None else decision["branches"][number]["others"]
                yield {
                    **{
                        name: decision[name]
                        for name in ("id", "scenario", "share", "seed", "departure_s", "trip", "at_s", "edge")
                    },
                    "delay_s": decision["delay_s"],
                    "eta_s": decision["eta_s"],
                    "time_index": round(decision["eta_s"] / max(1.0, decision["eta_s"] - decision["delay_s"]), 3),
                    "age_s": news["age_s"],
                    "policy": policy.text,
                    "complies": decision["complies"],
                    "rerouted": _took_another(policy, decision) if policy.agent else number is not None,
                    "promised_s": None
                    if news["offered_s"] is None
                    else round(news["stay_s"] - news["offered_s"], 1),
                    **{f"stay_{name}": decision["stay"][name] for name in METRICS},
                    **{f"gain_{name}": _gain(decision, number, name) for name in METRICS},
                    "regret_s": round(least_s - _gain(decision, number, "time_s"), 3),
                    "others": 0 if others is None else others["count"],
                    "others_gain_s": 0.0 if others is None else others["gain_s"],
                    "others_changed": 0 if others is None else others["changed"],
                    "unfinished_stay": 0 if others is None else others["unfinished_stay"],
                    "unfinished": 0 if others is None else others["unfinished"],
                }


def _took_another(policy: Policy, decision: Json) -> bool:
    """Whether an agent's branch, in which it may do anything, left the way."""
    return bool(decision["complies"]) and policy.agent in decision["agents_rerouted"]


def noise(decisions: Iterable[Json]) -> Noise:
    """What the placebos changed."""
    placebos = [each["placebo"] for each in decisions if each["placebo"] is not None]
    if not placebos:
        return Noise(0, 0.0, 0.0)
    times = [abs(each["gains"]["time_s"]) for each in placebos]
    others = [abs(each["others"]["gain_s"]) for each in placebos]
    return Noise(len(placebos), float(np.quantile(times, NOISE)), float(np.quantile(others, NOISE)))


def _gain(decision: Json, number: int | None, metric: str) -> float:
    return 0.0 if number is None else float(decision["branches"][number]["gains"][metric])
