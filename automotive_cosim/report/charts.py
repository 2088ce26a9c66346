"""Plots of an evaluation, in the colours of the page, and what all plots share."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from io import BytesIO
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.cockpit.theme import Weight, font
from automotive_cosim.contracts.plain import rounded
from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.report.findings import NAMES
from automotive_cosim.report.results import Contestant, Results, pairs
from automotive_cosim.report.stats import Rate
from automotive_cosim.report.summary import DIMENSIONS, dimensions, rate_of
from automotive_cosim.tasking.task import Module

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK = "#010203"
"""Placeholder for the colour of the text around the plot, which depends on the colour scheme."""
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#7f7f7f")
"""Okabe and Ito's colours, which most people can distinguish, without black and yellow, plus two more."""
DASHES: dict[str, Any] = {
    "full": "-",
    "none": ":",
    "irrelevant": "--",
    "gps": "-.",
    "context": (0, (6, 2)),
    "wrong": (0, (1, 3)),
}
"""Dashes of the geo controls."""
MARKERS = "osD^vP*X"
WIDE_IN, NARROW_IN = 9.6, 4.0
"""A page is at most 1040 pixels wide, a phone about 390; an inch is 96 pixels."""
DIGITS = 6
"""Significant digits along an axis: more than ticks have, fewer than rounding errors show."""
CHARACTERS_AN_INCH = 11.0
"""Of a legend, with room for its lines and marks."""
LARGE = 1000.0
"""From here on, numbers along an axis have commas between thousands."""
SAVED: Mapping[str, Mapping[str, Any]] = {
    "svg": {"transparent": True, "metadata": {"Date": None, "Creator": None}},
    "pdf": {"metadata": {"CreationDate": None}},
    "png": {"dpi": 200, "metadata": {"Software": None}},
}
"""How matplotlib saves each kind of file; the same plot gives the same bytes."""


Drawing = tuple[float, Callable[["Axes"], None]]
"""A plot: its height in inches, and the function that draws it."""


@dataclass(frozen=True, slots=True)
class Chart:
    """A plot of a page and its files."""

    name: str
    title: str
    drawing: Drawing
    """For a wide page and for files."""
    wide: str
    """SVG for a wide page."""
    narrow: str
    """SVG for a narrow one."""

    @classmethod
    def of(cls, name: str, title: str, drawing: Drawing, narrow: Drawing | None = None) -> Chart:
        """Draws it, for a narrow page by a drawing of its own if there is one.

        Raises SetupError: matplotlib is not installed."""
        return cls(name, title, drawing, drawn(name, drawing, WIDE_IN), drawn(name, narrow or drawing, NARROW_IN))

    @property
    def svg(self) -> str:
        """For a file, which knows no page around it."""
        return self.wide.replace("currentColor", INK)

    def files(self) -> Iterator[tuple[str, bytes]]:
        """Suffix and content of its files: SVG for the web, PDF for papers, PNG for slides."""
        yield "svg", self.svg.encode()
        for kind in ("pdf", "png"):
            yield kind, _saved(self.name, self.drawing, WIDE_IN, kind)


def charted(
    made: Mapping[str, tuple[str, Drawing | None]], narrow: Mapping[str, Drawing | None] | None = None
) -> dict[str, Chart]:
    """The plots that have something to show, by name.

    Args:
        narrow: drawings of those that have another one for a narrow page.

    Raises SetupError: matplotlib is not installed."""
    other = narrow or {}
    return {
        name: Chart.of(name, title, drawing, other.get(name))
        for name, (title, drawing) in made.items()
        if drawing is not None
    }


def charts(results: Results) -> dict[str, Chart]:
    """Plots by name; none without episodes. Raises SetupError: matplotlib is not installed."""
    if not results.rows:
        return {}
    made: dict[str, tuple[str, Drawing | None]] = {
        "dimensions": ("Success by dimension", _dimensions(results)),
        "modules": ("Success by module", _modules(results)),
        "prompts": ("Length of prompts", _prompts(results)),
        "distribution": ("Tasks by module and dimension", _distribution(results)),
    }
    return charted(made)


def is_installed() -> bool:
    """Whether plots can be drawn."""
    return find_spec("matplotlib") is not None


def require_plots() -> None:
    """Checks that matplotlib is installed before any work starts. Raises SetupError: it is not installed."""
    if not is_installed():
        raise SetupError(NEEDS)


NEEDS = f"plots need matplotlib: {install_hint('reports')}"


def _dimensions(results: Results) -> Drawing:
    ran = dimensions(results)
    has_pairs = any(pairs(results.of(each)) for each in results.contestants)

    def rates(each: Contestant) -> list[Rate]:
        mine = results.of(each)
        firsts = [row for row in mine if row.half == "first"]
        return [
            *(rate_of(row for row in firsts if row.dimension == name) for name in ran),
            *([rate_of(pair for pair, _ in pairs(mine))] if has_pairs else ()),
        ]

    return _rates(results, [*(DIMENSIONS[name] for name in ran), *(["Safety pairs"] if has_pairs else ())], rates)


def _modules(results: Results) -> Drawing:
    modules = [module for module in Module if any(row.module == module for row in results.rows)]

    def rates(each: Contestant) -> list[Rate]:
        return [rate_of(row for row in results.of(each) if row.module == module) for module in modules]

    return _rates(results, [NAMES.get(module, module.capitalize()) for module in modules], rates)


def _rates(results: Results, names: Sequence[str], rates: Callable[[Contestant], list[Rate]]) -> Drawing:
    """One row per name, with a point and its interval for each contestant."""
    contestants = results.contestants
    height_in = 0.9 + len(names) * (0.2 + 0.17 * len(contestants)) + 0.23 * len(contestants)

    def draw(axes: Axes) -> None:
        for number, each in enumerate(contestants):
            offset = (number - (len(contestants) - 1) / 2) * 0.8 / len(contestants)
            found = [(place + offset, rate) for place, rate in enumerate(rates(each)) if rate.interval is not None]
            values = [(rate.value or 0.0) * 100 for _, rate in found]
            bounds = [rate.interval for _, rate in found if rate.interval is not None]
            axes.errorbar(
                values,
                [place for place, _ in found],
                xerr=[
                    [max(0.0, value - bound.low * 100) for value, bound in zip(values, bounds, strict=True)],
                    [max(0.0, bound.high * 100 - value) for value, bound in zip(values, bounds, strict=True)],
                ],
                fmt=MARKERS[number % len(MARKERS)],
                color=PALETTE[number % len(PALETTE)],
                markerfacecolor="none" if each.agent in NOT_RANKED else PALETTE[number % len(PALETTE)],
                markersize=6,
                elinewidth=1.6,
                capsize=0,
                label=each.label,
            )
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.5, -0.5)
        axes.set_xlim(-2, 102)
        axes.set_xlabel("per cent, with 95 % intervals")
        legend(axes)

    return height_in, draw


def _prompts(results: Results) -> Drawing | None:
    """Cumulative distribution of prompt lengths; the dashes distinguish the geo controls."""
    lengths = {
        each: sorted(length for row in results.of(each) for length in row.prompt_tokens)
        for each in results.contestants
    }
    lengths = {each: found for each, found in lengths.items() if found}
    if not lengths:
        return None
    agents = list(dict.fromkeys((each.agent, each.model) for each in lengths))

    def draw(axes: Axes) -> None:
        for each, found in lengths.items():
            shares = [100 * (place + 1) / len(found) for place in range(len(found))]
            axes.step(
                [found[0], *found],
                [0, *shares],
                where="post",
                color=PALETTE[agents.index((each.agent, each.model)) % len(PALETTE)],
                linestyle=DASHES[each.conditions.geo],
                label=each.label,
            )
        axes.set_xlim(left=0)
        axes.set_ylim(0, 102)
        axes.set_ylabel("per cent of prompts")
        axes.set_xlabel("tokens or fewer")
        legend(axes)

    return 3.2 + 0.23 * len(lengths), draw


def _distribution(results: Results) -> Drawing:
    """Tasks by module, stacked by dimension."""
    tasks = {row.task: row for row in results.rows}.values()
    modules = [module for module in Module if any(row.module == module for row in tasks)]

    def draw(axes: Axes) -> None:
        done = [0] * len(modules)
        for name in dimensions(results):
            counts = [sum(row.module == module and row.dimension == name for row in tasks) for module in modules]
            colour = PALETTE[list(DIMENSIONS).index(name)]
            axes.barh(range(len(modules)), counts, left=done, height=0.6, color=colour, label=DIMENSIONS[name])
            done = [before + count for before, count in zip(done, counts, strict=True)]
        axes.set_yticks(range(len(modules)), [NAMES.get(module, module.capitalize()) for module in modules])
        axes.set_ylim(len(modules) - 0.5, -0.5)
        axes.set_xlabel("tasks")
        axes.locator_params(axis="x", integer=True)
        legend(axes)

    return 1.9 + 0.32 * len(modules), draw


def legend(axes: Axes, **options: Any) -> None:
    """The legend, above the plot and no wider, with the options of matplotlib's."""
    handles, labels = axes.get_legend_handles_labels()
    most = round(CHARACTERS_AN_INCH * axes.figure.bbox.width / axes.figure.dpi / options.get("ncols", 1))
    axes.figure.legend(
        handles,
        ["\n".join(wrap(label, most)) for label in labels],
        **{"loc": "outside upper left", "frameon": False, "handletextpad": 0.6, **options},
    )


def _write_plainly(figure: Figure) -> None:
    """Numbers along the axes as people write them, without powers of ten; other labels stay."""
    from matplotlib.axis import Axis
    from matplotlib.ticker import Formatter, LogFormatter, ScalarFormatter

    class _WrittenOut(Formatter):
        """Shows what another formatter does; large numbers, and those of a logarithmic axis, in other digits."""

        def __init__(self, before: LogFormatter | ScalarFormatter) -> None:
            self._before = before
            self._keeps = LARGE if isinstance(before, ScalarFormatter) else 0.0
            if isinstance(before, ScalarFormatter):
                before.set_scientific(False)
                before.set_useOffset(False)

        def __call__(self, x: float, pos: int | None = None) -> str:
            return self._told(x, self._before(x, pos))

        def format_ticks(self, values: list[float]) -> list[str]:
            return list(map(self._told, values, self._before.format_ticks(values)))

        def _told(self, value: float, text: str) -> str:
            return text if not text or abs(value) < self._keeps else rounded(value, DIGITS)

    for axis in figure.findobj(Axis):
        for before, replace in (
            (axis.get_major_formatter(), axis.set_major_formatter),
            (axis.get_minor_formatter(), axis.set_minor_formatter),
        ):
            if isinstance(before, LogFormatter | ScalarFormatter):
                replace(_WrittenOut(before))


def drawn(name: str, drawing: Drawing, width_in: float) -> str:
    """A plot as SVG, with ids that are unique on the page. Raises SetupError: matplotlib is not installed."""
    svg = _saved(name, drawing, width_in, "svg").decode()
    # An id may occur only once on a page with several plots.
    own = re.sub(r'( id="|href="#|url\(#)', rf"\g<1>{name}-{width_in:.0f}-", svg[svg.index("<svg") :])
    return own.replace(INK, "currentColor")


def _saved(name: str, drawing: Drawing, width_in: float, kind: str) -> bytes:
    """A plot as a file of a kind in ``SAVED``. Raises SetupError: matplotlib is not installed."""
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError as error:
        raise SetupError(NEEDS) from error
    height_in, draw = drawing
    style: Any = {
        "svg.fonttype": "none",
        "svg.hashsalt": f"{name} {width_in}",
        "font.family": ["sans-serif"] if kind == "svg" else _families(),
        "font.size": 10,
        "text.parse_math": False,  # names of agents may hold dollars
        **dict.fromkeys(("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color"), INK),
    }
    with mpl.rc_context(style), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # the fonts of whoever opens the file show the texts, not ours
        figure = Figure(figsize=(width_in, height_in), layout="constrained")
        axes = figure.subplots()
        axes.grid(axis="x", color=INK, alpha=0.15, linewidth=0.8)
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.tick_params(length=0)
        draw(axes)
        _write_plainly(figure)
        content = BytesIO()
        figure.savefig(content, format=kind, **SAVED[kind])
    return content.getvalue()


@cache
def _families() -> list[str]:
    """Fonts with the letters of all places: a PDF and a PNG hold what is drawn, not texts."""
    from matplotlib.font_manager import fontManager

    path = str(font(Weight.EAST_ASIAN, 10).path)
    fontManager.addfont(path)
    return ["DejaVu Sans", next(each.name for each in fontManager.ttflist if each.fname == path)]
