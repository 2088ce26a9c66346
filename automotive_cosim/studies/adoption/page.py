"""The report of a study of adoption."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from automotive_cosim.contracts.plain import counted
from automotive_cosim.report.charts import INK, MARKERS, PALETTE, Chart, Drawing, charted, legend
from automotive_cosim.report.fleet import FleetCar, shown_fleet
from automotive_cosim.report.tables import Table
from automotive_cosim.run.fleet_record import read_fleet
from automotive_cosim.studies.adoption.adoption import (
    AdoptionStudy,
    Cohort,
    EquippedCar,
    ShareOutcome,
    fleet_id,
    percent,
)
from automotive_cosim.studies.content import ShownStudy
from automotive_cosim.studies.intervals import LEAST_SEEDS, SeedMean, seed_mean
from automotive_cosim.studies.reroute.tables import NONE, told_mean
from automotive_cosim.studies.reroute.warnings import missing_told

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Of = Callable[[ShareOutcome], "float | None"]
KINDS = {
    "sooner": "sooner than at share 0",
    "later": "later",
    "same": "at the same time",
    "failed": "its assistant failed",
}
"""Cars on a map, by how they look."""
COLUMNS = "Departs, s", "Trip, s", "Gain, s", "Routes changed", "Warnings"
"""Figures of a car."""
NOTICED_S = 0.5
"""A gain at the smallest share of less is none of which a part could be gone: our choice."""


def shown(study: AdoptionStudy) -> ShownStudy:
    """What the report shows."""
    plan = study.plan
    about = f"{plan.agent}, {counted(len(plan.seeds), 'seed')}, {plan.minutes:g} minutes"
    picture, pages = fleets(study)
    return ShownStudy(
        "Study of adoption",
        about,
        answer(study),
        warnings(study),
        [effects(study), assistants(study)],
        charts(study),
        picture,
        pages,
    )


def fleets(study: AdoptionStudy) -> tuple[str, dict[str, str]]:
    """The equipped cars of the first seed: a map of the greatest share with links, and a page for each share.

    Raises UserError: a record is damaged."""
    row = next((each for each in study.rows if each.shares), None)
    last, links, pages = "", [], {}
    for outcome in row.shares if row else ():
        fleet = read_fleet(study.folder, fleet_id(row.seed, outcome.share)) if row and outcome.cars else None
        if row is None or fleet is None:
            continue
        name = f"cars-{fleet_id(row.seed, outcome.share)}.html"
        cars, of_all = list(map(shown_car, outcome.cars)), f"{percent(outcome.share)} of all"
        last, pages[name] = shown_fleet(
            fleet,
            cars,
            KINDS,
            COLUMNS,
            name,
            title=f"{counted(len(cars), 'car')} with the assistant, {of_all}, seed {row.seed}",
            about=f"{study.plan.agent}, {study.plan.scenario}",
            note="Gain: how much sooner the car arrives than at share 0, in a copy of the same traffic.",
        )
        links.append(f'<a href="{name}">{percent(outcome.share)}, {counted(len(cars), "car")}</a>')
    told = (
        f'<h2 id="cars">The cars of seed {row.seed}</h2>\n<p>Each car by itself: {" · ".join(links)}</p>'
        if row
        else ""
    )
    return (f"{told}\n{last}" if links else "", pages)


def shown_car(car: EquippedCar) -> FleetCar:
    """An equipped car on the map and in the list."""
    gain_s = None if car.before_s is None else car.before_s - car.time_s
    kind = "failed" if car.error else "same" if not gain_s else "sooner" if gain_s > 0 else "later"
    told = (
        f"{'arrives' if car.arrived else 'is still on its way'} after {car.time_s:.0f} s and {car.driven_m:.0f} m"
    )
    without = (
        "does not set out in time without"
        if gain_s is None
        else f"{_sooner(gain_s)} {'than' if abs(gain_s) >= 0.05 else 'as'} at share 0"
    )
    trip, gain = f"{car.time_s:.0f}{'' if car.arrived else ' so far'}", NONE if gain_s is None else f"{gain_s:+.0f}"
    cells = f"{car.departs_s:.0f}", trip, gain, str(car.reroutes), str(car.warnings)
    return FleetCar(car.car, kind, f"{told}, {without}", cells, car.error)


def mean(study: AdoptionStudy, share: float, of: Of) -> SeedMean | None:
    """The mean of a figure of a share over the seeds."""
    return seed_mean((seed, value) for seed, each in study.of(share) if (value := of(each)) is not None)


def gain(cohort: Callable[[ShareOutcome], Cohort | None]) -> Of:
    """How much sooner the cars of a cohort arrive than the same cars at share 0."""

    def found(outcome: ShareOutcome) -> float | None:
        cars = cohort(outcome)
        return None if cars is None else cars.before_s - cars.time_s

    return found


EQUIPPED, OTHERS, ALL = (
    gain(lambda each: each.equipped),
    gain(lambda each: each.others),
    gain(lambda each: each.all),
)


def gone(study: AdoptionStudy) -> tuple[float, float, float, SeedMean] | None:
    """How much of what an equipped car gains at the smallest share is gone at half, or at the share nearest to it:
    the two shares, the part, above 1 if it loses there, and the seconds; None without a gain at the smallest."""
    shares = [share for share in study.shares if share > 0]
    if len(shares) < 2:
        return None
    least, half = shares[0], min(shares[1:], key=lambda share: abs(share - 0.5))
    first, then = ({seed: EQUIPPED(each) for seed, each in study.of(share)} for share in (least, half))
    pairs = [
        (seed, gain_s, gain_s - left_s)
        for seed, gain_s in first.items()
        if gain_s is not None and (left_s := then.get(seed)) is not None
    ]
    gained, lost = (seed_mean((pair[0], pair[number]) for pair in pairs) for number in (1, 2))
    if gained is None or lost is None or gained.value < NOTICED_S:
        return None
    return least, half, lost.value / gained.value, lost


def answer(study: AdoptionStudy) -> str:
    """What an assistant does to who has it and to the others, and how much of it is gone when many have it."""
    shares = [share for share in study.shares if share > 0]
    least = mean(study, shares[0], EQUIPPED) if shares else None
    if least is None:
        return "No car of any share had the assistant."
    text = f"With the assistant in {percent(shares[0])} of the cars, one that has it arrives {_sooner(least.value)}"
    herding = gone(study)
    if herding is not None:
        _, half, part, lost = herding
        then = mean(study, half, EQUIPPED)
        assert then is not None
        text += f"; in {percent(half)}, {_sooner(then.value)}: {part:.0%} of the gain is gone{_how_sure(lost)}"
    everybody = mean(study, shares[-1], ALL)
    if everybody is not None:
        text += f". At {percent(shares[-1])}, all cars together arrive {_sooner(everybody.value)} per car"
    return f"{text}; over {counted(least.seeds, 'seed')}."


def _how_sure(lost: SeedMean) -> str:
    """What may be chance in the seconds that are gone."""
    if lost.interval is None:
        return f", which {counted(lost.seeds, 'seed')} cannot tell from chance"
    may_be_none = ", which may be chance" if lost.interval.low <= 0 <= lost.interval.high else ""
    return f" (95 %: {lost.interval.low:.1f} to {lost.interval.high:.1f} s{may_be_none})"


def _sooner(seconds: float) -> str:
    if abs(seconds) < 0.05:
        return "at the same time"
    return f"{abs(seconds):.1f} s {'sooner' if seconds > 0 else 'later'}"


def warnings(study: AdoptionStudy) -> list[str]:
    """Warnings to read before using the study's figures."""
    found = list(missing_told(len(study.plan.jobs()), len(study.rows), "seed"))
    seeds = len(study.plan.seeds)
    if seeds < LEAST_SEEDS:
        found.append(f"{counted(seeds, 'seed')}: no interval of a mean below {LEAST_SEEDS} seeds.")
    outcomes = [each for row in study.rows for each in row.shares]
    late = sum(each.all.cars - each.all.arrived for each in outcomes)
    if late:
        found.append(f"{counted(late, 'trip')} had not ended with the time and count up to then.")
    failed = sum(each.failed for each in outcomes)
    if failed:
        found.append(f"The agent failed in {counted(failed, 'car')}, which drove on without it.")
    refused = [car.refused for each in outcomes for car in each.cars if car.refused]
    if refused:
        answers, cars = counted(sum(refused), "answer"), counted(len(refused), "car")
        found.append(f"{answers} in {cars} were no action, or the agent raised; the pages of these cars say why.")
    return found


def effects(study: AdoptionStudy) -> Table:
    """What every share does to the town."""
    columns = {
        "Equipped gain, s": (EQUIPPED, "+.1f"),
        "Others gain, s": (OTHERS, "+.1f"),
        "All gain, s": (ALL, "+.1f"),
        "Trip, s": (lambda each: each.all.time_s, ".1f"),
        "Lost, s": (lambda each: each.all.lost_s, ".1f"),
        "Side streets, %": (lambda each: 100 * each.all.side, ".1f"),
        "Near collisions, s/h": (lambda each: each.all.near_s_h, ".1f"),
        "Energy, Wh/km": (lambda each: each.all.energy_wh_km, ".0f"),
    }
    rows = tuple(
        (f"{percent(share)}", *(told_mean(mean(study, share, of), form) for of, form in columns.values()))
        for share in study.shares
    )
    note = (
        "Means per car over the seeds. Gain: how much sooner cars arrive than the same cars at share 0, in copies "
        "of the same traffic; trips count from when each wants to set out to its arrival or the end. Lost: SUMO's "
        "timeLoss. Near collisions: time below the customary time to collision to the car ahead."
    )
    return Table("effects", "What the assistant does to the town", ("Equipped", *columns), rows, note)


def assistants(study: AdoptionStudy) -> Table:
    """What the assistants did."""
    columns = {
        "Equipped cars": lambda each: 0.0 if each.equipped is None else float(each.equipped.cars),
        "Routes changed": lambda each: float(each.reroutes),
        "Warnings": lambda each: float(each.warnings),
        "Hazards": lambda each: float(each.hazards),
    }
    rows = []
    for share in study.shares:
        per = mean(study, share, lambda each: each.warnings / each.hazards if each.hazards else None)
        told = (told_mean(mean(study, share, of), ".1f") for of in columns.values())
        rows.append((f"{percent(share)}", *told, NONE if per is None else told_mean(per, ".1f")))
    note = "A hazard: warnings of one kind on one road within a minute are of the same."
    return Table(
        "assistants", "What the assistants did", ("Share", *columns, "Warnings a hazard"), tuple(rows), note
    )


def charts(study: AdoptionStudy) -> dict[str, Chart]:
    """Plots by name. Raises SetupError: matplotlib is not installed."""
    return charted({"gains": ("How much sooner cars arrive, by the share that is equipped", _gains(study))})


def _gains(study: AdoptionStudy) -> Drawing | None:
    if len(study.shares) < 2:
        return None

    def draw(axes: Axes) -> None:
        for number, (name, of) in enumerate({"equipped": EQUIPPED, "others": OTHERS, "all": ALL}.items()):
            known = [(share, found) for share in study.shares if (found := mean(study, share, of)) is not None]
            axes.errorbar(
                [100 * share for share, _ in known],
                [found.value for _, found in known],
                yerr=[0.0 if found.interval is None else found.interval.high - found.value for _, found in known],
                marker=MARKERS[number],
                color=PALETTE[number],
                markersize=6,
                label=name,
            )
        axes.axhline(0.0, color=INK, linewidth=0.8)
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("% of the cars equipped")
        axes.set_ylabel("sooner than at 0 %, s")
        legend(axes)

    return 4.0, draw
