"""A small town and what is outside in it, made by hand."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.memo import RECORD
from automotive_cosim.cockpit.apps.phone.state import FigureDraft, Phone
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.apps.timer import START_TIMER
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.commands import Put, Set
from automotive_cosim.cockpit.messages import Focus, Pick, Show
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.cockpit.signals import MEDIA
from automotive_cosim.cockpit.widgets import Widget
from automotive_cosim.contracts import (
    Around,
    Connectivity,
    Direction,
    DrivingState,
    FeedbackCode,
    GpsFix,
    Limit,
    LimitSource,
    Road,
    RoadAhead,
    RoadHere,
    RoadNetwork,
    Surroundings,
    Weather,
)
from automotive_cosim.contracts.ids import resource_id as shown_id
from tests.cockpit.fingers import middle

NAMES = (
    "Rue de Rivoli",
    "Boulevard de Sébastopol",
    "Rue Saint-Honoré",
    "Quai des Tuileries",
    "Avenue de l'Opéra",
    "Rue du Faubourg Saint-Antoine",
    "Pont Neuf",
    "Rue des Pyramides",
    "Boulevard Saint-Germain",
    "Rue de la Paix",
    "Place de la Concorde",
    "Voie Georges Pompidou",
)


def town() -> RoadNetwork:
    """A grid of 12 by 12 streets, 120 m apart, some wide, one under ground."""
    roads = []
    for line in range(12):
        for piece in range(11):
            for way, (a, b) in {
                "e": ((piece * 120.0, line * 120.0), (piece * 120.0 + 120, line * 120.0)),
                "n": ((line * 120.0, piece * 120.0), (line * 120.0, piece * 120.0 + 120)),
            }.items():
                wide = line % 4 == 2
                roads.append(
                    Road(
                        edge_id=f"{way}{line}_{piece}",
                        name=NAMES[line] if way == "e" else NAMES[(line + 5) % 12] + " Nord",
                        road_class="primary" if wide else "residential",
                        lane_count=3 if wide else 1,
                        length_m=120.0,
                        limit_mps=50 / 3.6 if wide else 30 / 3.6,
                        limit_source=LimitSource.POSTED,
                        in_tunnel=way == "e" and line == 9,
                        shape_m=(a, ((a[0] + b[0]) / 2 + 4, (a[1] + b[1]) / 2 + 3), b),
                    )
                )
    return RoadNetwork(tuple(roads), (0, 0, 1320, 1320), "+proj=utm +zone=31", (0, 0), False)


def outside(time_s: float = 900.0, speed_kmh: float = 48.0, **changes: object) -> Surroundings:
    """Driving north-east through the town on a mild evening."""
    here = RoadHere(
        "e6_5", "e6_5_0", 0, 3, 40.0, "Boulevard de Sébastopol", "primary", Limit(50 / 3.6, LimitSource.POSTED),
        False, True, True, True, 1.0,
    )  # fmt: skip
    ahead = RoadAhead(
        4210.0, 640.0, 95.0, 0.6, 900.0, 300.0, None, Limit(30 / 3.6, LimitSource.POSTED), 400.0, None, None,
        ("e6_5", "e6_6", "n7_6", "n7_7", "e8_7", "e8_8"),
    )  # fmt: skip
    driving = DrivingState(
        time_s, 660.0, 722.0, 2.34, 48.86, 62.0, speed_kmh / 3.6, 0.0, 0.0, 1200.0, here, ahead,
        Around(None, None, None, None, 0.8), False, 400,
    )  # fmt: skip
    base = Surroundings(
        driving,
        Weather(14.0, 55.0, 0.0, 1, 20.0, 20000.0, 8.0),
        datetime(2026, 5, 12, 14, 5, tzinfo=ZoneInfo("Europe/Paris")),
        40.0,
        GpsFix(True, 2.34, 48.86, 3.0, 0.0, 62.0),
        Connectivity(True, "5g", 3),
    )
    return replace(base, **changes)  # type: ignore[arg-type]


@dataclass(frozen=True)
class View:
    """A screen as a walk from home found it."""

    name: str
    way: tuple[str, ...]
    """Widgets to tap, from home on."""
    cockpit: Cockpit


def walk(home: Cockpit) -> tuple[View, ...]:
    """Every view that taps on widgets lead to from home: screens, and the parts that they can show.

    Of the lines of a list that lead to the same screen, the first is taken."""
    home.open_app("home")
    found = {"home": View("home", (), home)}
    ahead = deque(found.values())
    while ahead:
        view = ahead.popleft()
        further = view.cockpit.copy()  # a make's own screens lead on below, too
        if further.screen in further.state.make.screens and _scrolled(further):
            found[f"{view.name} further"] = View(f"{view.name} further", view.way, further)
            ahead.append(found[f"{view.name} further"])
        for widget in view.cockpit.tree.walk():
            name = _leads_to(widget, view.cockpit)
            taken = getattr(widget, "selected", False) and not isinstance(widget.on_tap, Show)
            if not name or name in found or not widget.usable or taken:
                continue
            there = view.cockpit.copy()
            element = next(one for one in there.elements() if one.resource_id == shown_id(widget.key))
            assert there.tap(*middle(element)).code is FeedbackCode.OK, f"{view.name}: {widget.key}"
            found[name] = View(name, (*view.way, widget.key), there)
            ahead.append(found[name])
    return tuple(found.values())


def _scrolled(cockpit: Cockpit) -> bool:
    return cockpit.scroll(f"{cockpit.screen}.all", Direction.DOWN).code is FeedbackCode.OK


def _leads_to(widget: Widget, here: Cockpit) -> str:
    installed = here.commands()["apps.installed"]
    more = [name for name in installed if not apps()[name].preinstalled]
    match widget.on_tap:
        case Pick(key, value) if not value.isdigit() and key != "media.show":
            return f"{here.screen} {key}={value}"
        case Show(screen, item) if screen == "explore":
            return f"explore {item}"
        case Focus():
            return f"{here.screen} typing"
        case Put(Phone(draft=FigureDraft(sentence="own"))):
            return "figure in own words"
        case Show("apps") if more and here.screen == "store":
            return f"apps with {more[0]}"
        case Show(screen):
            return screen
        case Put(Installed(names)) if not more and set(names) > set(installed):
            return f"store with {next(name for name in names if name not in installed)}"
        case _ if widget.on_tap == RECORD and here.commands()["apps.recording"]:
            return "memo with a memo"
        case _ if widget.on_tap == RECORD and not here.commands()["apps.memos"]:
            return "memo recording"
        case _ if widget.on_tap == START_TIMER:
            return "timer running"
        case Set(signal, value) if signal is MEDIA.SOURCE:
            return f"media from {value}"
        case _:
            return ""


@pytest.fixture(scope="session")
def network() -> RoadNetwork:
    return town()


@pytest.fixture
def make(network: RoadNetwork) -> Callable[..., Cockpit]:
    """A cockpit that has looked outside."""

    def build(
        seed: int = 1, surroundings: Surroundings | None = None, left_hand: bool = False, **options: object
    ) -> Cockpit:
        here = replace(network, left_hand=left_hand)
        cockpit = Cockpit(here, rng=np.random.default_rng(seed), **options)  # type: ignore[arg-type]
        cockpit.sense(surroundings or outside(), 0.0)
        return cockpit

    return build


@pytest.fixture
def cockpit(make: Callable[..., Cockpit]) -> Cockpit:
    return make()


@pytest.fixture
def around() -> Surroundings:
    return outside()


@pytest.fixture(scope="session")
def walker() -> Callable[[Cockpit], tuple[View, ...]]:
    return walk


@pytest.fixture(scope="session")
def outdoors() -> Callable[..., Surroundings]:
    return outside
