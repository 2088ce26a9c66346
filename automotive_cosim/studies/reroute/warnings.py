"""What to read before using a study's figures: each kind of warning finds its case in the results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from statistics import fmean

from automotive_cosim.agents import PROFILES
from automotive_cosim.contracts.plain import counted
from automotive_cosim.scenarios import Scenario
from automotive_cosim.studies.calls.chance import Fresh
from automotive_cosim.studies.intervals import LEAST_SEEDS, PUBLISHED_SEEDS
from automotive_cosim.studies.reroute.plan import named
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.tables import groups

Finds = Callable[[Study], Iterator[str]]


def warnings(study: Study) -> list[str]:
    """All warnings, each a sentence or two."""
    return [told for kind in KINDS for told in kind(study)]


def unfinished(study: Study) -> Iterator[str]:
    """Drives of the plan have not run yet."""
    yield from missing_told(study.planned, len(study.rows), "drive")


def missing_told(planned: int, ran: int, unit: str) -> Iterator[str]:
    """The same for any kind of study."""
    if ran < planned:
        yield (
            f"{planned - ran} of {counted(planned, unit)} are missing, so the figures are those of a part: rerun "
            "the `study` command to resume."
        )


def nothing_counted(study: Study) -> Iterator[str]:
    """No decision counted at all."""
    if not study.decisions:
        told = "; ".join(f"{count} × {reason}" for (_, reason), count in sorted(study.excluded.items()))
        yield f"No decision counted, so there is nothing to average: {told or 'every drive failed'}."


def few_seeds(study: Study) -> Iterator[str]:
    """A share of rerouting cars has too few seeds for an interval, or all have too few to publish."""
    ran = {share: {row.seed for row in study.rows if row.share == share} for share in _shares(study)}
    deciding = {
        share: {point.drive.seed for point in study.decisions if point.drive.share == share} for share in ran
    }
    counts = [len(seeds) for seeds in deciding.values()]
    if not study.decisions:
        return
    for share, seeds in deciding.items():
        where = f", where {share:.0%} of the others reroute," if len(ran) > 1 else ""
        if len(seeds) < LEAST_SEEDS:
            of = "" if len(seeds) == len(ran[share]) else f" of {len(ran[share])}"
            had = "has" if len(seeds) == 1 and not of else "have"
            yield (
                f"{len(seeds)}{of} {'seed' if len(seeds) == 1 and not of else 'seeds'}{where} {had} a decision: "
                f"confidence intervals need {LEAST_SEEDS} seeds, because decisions of one seed are correlated."
            )
    if LEAST_SEEDS <= min(counts) < PUBLISHED_SEEDS:
        yield f"{min(counts)} seeds have a decision: run {PUBLISHED_SEEDS} before publishing."


def gain_beyond_delay(study: Study) -> Iterator[str]:
    """A policy gains more than the kept route lost: it did not only avoid congestion."""
    for share, policy, _, chosen in groups(study):
        known = [each for each in chosen if each.lost_ahead_s is not None and each.gain.way_s is not None]
        if not known:
            continue
        gain_s = fmean(each.gain.time_s for each in known)
        lost_s = fmean(each.lost_ahead_s or 0.0 for each in known)
        if gain_s > lost_s:
            way_s = fmean(each.gain.way_s or 0.0 for each in known)
            where = f" where {share:.0%} of the others reroute" if len(_shares(study)) > 1 else ""
            yield (
                f"“{policy}” saves {gain_s:.0f} s a decision{where}, more than the {lost_s:.0f} s that the kept "
                f"route lost to traffic and signals: {way_s:.0f} s of it is a quicker way, not congestion avoided."
            )


def one_trip(study: Study) -> Iterator[str]:
    """All decisions come from one trip."""
    trips = {point.drive.trip for point in study.decisions}
    if len(trips) == 1:
        many = (
            "The only decision comes" if len(study.decisions) == 1 else f"All {len(study.decisions)} decisions come"
        )
        yield f"{many} from one trip, “{trips.pop()}”: the result is about that trip and not about the network."


def placebos(study: Study) -> Iterator[str]:
    """There is no noise floor, or it cannot be believed."""
    noise = study.noise()
    step_s = study.plan.driven_step_s(study.plan.opened)
    if study.decisions and not noise.placebos:
        yield "There is no placebo, so the noise floor is unknown and any difference counts."
    elif noise.placebos and not noise.is_known:
        yield (
            f"{counted(noise.placebos, 'placebo')} with fresh random numbers moved nothing, neither the ego nor "
            "anybody else: either nothing in this traffic is left to chance, or chance is not measured here, so "
            "wins and losses are not told from it."
        )
    elif noise.placebos and not noise.time_s:
        yield (
            f"{counted(noise.placebos, 'placebo')} with fresh random numbers moved others, but never the ego's "
            f"arrival, which is told in steps of {step_s:g} s: wins and losses of that size are not "
            "told from chance."
        )


def other_steps(study: Study) -> Iterator[str]:
    """The study drives at other steps than the scenario's files state."""
    yield from steps_told(study.plan.opened, study.plan.driven_step_s(study.plan.opened))


def steps_told(scenario: Scenario, driven_s: float) -> Iterator[str]:
    """The same for any study of a scenario."""
    own_s = scenario.sumo.step_length_s
    if own_s != driven_s and not scenario.sumo.random_traffic_per_km_h:
        yield (
            f"Driven at steps of {driven_s:g} s, while the scenario's own are {own_s:g} s: figures differ from "
            f"those at its own steps (--step {own_s:g})."
        )


def understated_chance(study: Study) -> Iterator[str]:
    """The futures differ by less than chance."""
    if any(row.fresh is Fresh.JITTER for row in study.rows):
        yield (
            "SUMO could not be reseeded here: the routes differ by a small change of every other car's speed, "
            "which understates chance."
        )


def stand_in(study: Study) -> Iterator[str]:
    """An agent ran on the deterministic stand-in for a model."""
    if any(name in PROFILES and model == "rules" for name, model in map(named, study.plan.agents)):
        yield "“rules” is a deterministic stand-in: its rows say nothing about how well a language model performs."


KINDS: tuple[Finds, ...] = (
    unfinished,
    nothing_counted,
    few_seeds,
    gain_beyond_delay,
    one_trip,
    placebos,
    other_steps,
    understated_chance,
    stand_in,
)
"""All kinds, in the order of the report."""


def _shares(study: Study) -> list[float]:
    return sorted({row.share for row in study.rows})
