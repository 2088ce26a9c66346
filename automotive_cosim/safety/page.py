"""What a search leaves in its folder: rows, failures as plans, and a page with the
margin over each number that it varies; and the regression plan."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from automotive_cosim.agents import MODELLED
from automotive_cosim.contracts import Json
from automotive_cosim.formats.writing import make_folder, write_whole
from automotive_cosim.report.charts import NEEDS, PALETTE, Chart, Drawing, charted, is_installed, legend
from automotive_cosim.report.templates import render
from automotive_cosim.run.plan import PlannedTrial
from automotive_cosim.run.store import cannot_write, read_manifest
from automotive_cosim.safety.findings import as_json, judged, nothing_due, sentence, tables
from automotive_cosim.safety.hunt import Hunt, MinimalFailure, Tried
from automotive_cosim.safety.space import FactorRange, SearchPoint, label_of
from automotive_cosim.safety.trying import trial_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEIGHT_IN = 2.6
MOST_PARTS, POINTS_A_PART = 12, 4
"""Parts of a range whose means are drawn at most, and samples for each."""


def curves(found: Hunt) -> dict[str, Chart]:
    """A plot for each ordered number; none without matplotlib."""
    if not is_installed():
        return {}
    ordered = [each for each in found.space.factors if isinstance(each, FactorRange) and each.is_ordered]
    return charted(
        {f"curve-{each.name}": (f"Margin by {label_of(each.name)[0]}", _curve(found, each)) for each in ordered}
        if judged(found.samples)
        else {}
    )


def means(found: Hunt, factor: FactorRange) -> list[tuple[float, float]]:
    """The middle of each part of a range that has samples, as a coordinate, and their mean margin."""
    samples = judged(found.samples)
    parts = max(2, min(MOST_PARTS, len(samples) // POINTS_A_PART))
    groups: dict[int, list[float]] = {}
    for each in samples:
        unit = factor.unit(each.point[factor.name])
        groups.setdefault(min(parts - 1, int(unit * parts)), []).append(each.outcome.margin or 0.0)
    return [((part + 0.5) / parts, sum(group) / len(group)) for part, group in sorted(groups.items())]


def _curve(found: Hunt, factor: FactorRange) -> Drawing:
    samples = judged(found.samples)

    def draw(axes: Axes) -> None:
        for is_failed, colour, label in ((False, PALETTE[0], "passed"), (True, PALETTE[1], "failed")):
            mine = [each for each in samples if each.outcome.failed is is_failed]
            if mine:
                places = [float(each.point[factor.name]) for each in mine]
                axes.plot(
                    places, [each.outcome.margin or 0.0 for each in mine], "o", color=colour, label=label, alpha=0.6
                )
        line = means(found, factor)
        axes.plot(
            [float(factor.at(unit)) for unit, _ in line], [mean for _, mean in line], color=PALETTE[2], label="mean"
        )
        axes.axhline(0, color=PALETTE[7], linewidth=0.8)
        if factor.logarithmic:
            axes.set_xscale("log")
        axes.set_xlabel(", ".join(filter(None, label_of(factor.name))))
        axes.set_ylabel("margin")
        legend(axes)

    return HEIGHT_IN, draw


ROWS, FINDINGS, PAGE, PLANS = "tried.jsonl", "findings.json", "search.html", "failures"


def write_findings(folder: Path, found: Hunt, agent: str, model: str, about: Json) -> Path:
    """Writes rows, findings, plans of the failures and the page; returns the page.

    Raises UserError: they cannot be written."""
    try:
        lines = (json.dumps(row_of(each), ensure_ascii=False) for each in found.tried)
        write_whole(folder / ROWS, "".join(f"{line}\n" for line in lines))
        write_whole(folder / FINDINGS, json.dumps(as_json(found), indent=1, ensure_ascii=False) + "\n")
        for number, each in enumerate(found.minimal, 1):
            write_whole(
                make_folder(folder, PLANS) / f"{number:02d}.toml", regression_plan(found, agent, model, [each])
            )
        page = folder / PAGE
        write_whole(page, _page(folder, found, agent, model, about))
    except OSError as error:
        raise cannot_write(folder, error) from error
    return page


def row_of(each: Tried) -> Json:
    """A run as a line of ``tried.jsonl``."""
    return {
        "number": each.number,
        "phase": each.phase,
        "even": each.even,
        "repeat": each.repeat,
        "point": dict(each.point),
        **asdict(each.outcome),
    }


def regression_plan(found: Hunt, agent: str, model: str, failures: list[MinimalFailure] | None = None) -> str:
    """A plan with each minimal failure and its passing neighbour, for ``eval --plan`` and ``compare``.

    Args:
        failures: those to write; None for all, with the failures that were not reduced.
    """
    lines = [f"agents = [{json.dumps(agent)}]", f"models = [{json.dumps(model)}]"]
    for one in found.not_reduced if failures is None else ():
        lines += ["", f"# fails, not reduced: {one.outcome.why}", *_entry(one.point)]
    for each in found.minimal if failures is None else failures:
        lines += ["", f"# fails with {each.words(found.space)}: {each.why}", *_entry(each.point)]
        if each.neighbour is not None:
            lines += [
                "",
                f"# {each.beside}",
                *_entry(each.neighbour),
            ]
    return "\n".join(lines) + "\n"


def _entry(point: SearchPoint) -> Iterator[str]:
    trial, plain = trial_of(point), PlannedTrial()
    yield "[[trials]]"
    for name in ("task", "half", "drive", "scenario", "seed", "held_out"):
        if (value := getattr(trial, name)) != getattr(plain, name):
            yield f"{name} = {json.dumps(value, ensure_ascii=False)}"
    for table in ("conditions", "settings"):
        given, usual = asdict(getattr(trial, table)), asdict(getattr(plain, table))
        changed = {name: value for name, value in given.items() if value != usual[name]}
        if changed:
            yield f"[trials.{table}]"
        for name, value in changed.items():
            yield f"{name} = {json.dumps(value, ensure_ascii=False)}"


def _page(folder: Path, found: Hunt, agent: str, model: str, about: Json) -> str:
    made = tables(found)
    return render(
        "safety/search.html",
        agent=agent,
        model=model,
        about={name: value for name, value in about.items() if name != "model" or agent in MODELLED},
        found=found,
        sentence=sentence(found, agent),
        failures=len(found.minimal),
        failed=sum(each.outcome.failed for each in found.samples),
        empty=len(nothing_due(found.samples)),
        judged=len(judged(found.samples)),
        tables=made,
        curves=curves(found),
        no_curves="" if is_installed() else NEEDS,
        starts=read_manifest(folder)["starts"],
        stand_in=model == "rules" and agent in MODELLED,
    )
