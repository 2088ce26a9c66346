"""Fixtures about a village that does not exist, on real-looking ground in the Beauce: main street, back lanes, a
roundabout, a signalled crossroads, a tunnel, a motorway without a limit, and a footpath that cars cannot use."""

import bz2
import gzip
from collections.abc import Callable
from pathlib import Path

import pytest

from automotive_cosim.osm.importer import import_map
from automotive_cosim.osm.report import ImportReport
from automotive_cosim.osm.settings import ImportOptions
from tests.osm.maps import ORIGIN, Map


def village(origin: tuple[float, float] = ORIGIN) -> Map:
    """The whole village, elsewhere if asked for."""
    made = Map(origin)
    for row in range(5):
        for column in range(6):
            made.nodes[f"n{column}{row}"] = (column * 160.0, row * 160.0)
    for index, (x, y) in enumerate(((-60, 320), (-75, 335), (-90, 320), (-75, 305))):
        made.nodes[f"r{index}"] = (float(x), float(y))
    made.nodes |= {"west": (-700.0, 320.0), "t1": (1000.0, 330.0), "t2": (1200.0, 360.0), "east": (1900.0, 420.0)}
    made.nodes |= {"d1": (-700.0, 1500.0), "d2": (900.0, 1500.0), "d3": (2400.0, 1600.0), "ramp": (400.0, 1100.0)}
    made.nodes |= {"d4": (2400.0, 1620.0), "d5": (900.0, 1520.0), "d6": (-700.0, 1520.0)}
    made.node_tags["n22"] = {"highway": "traffic_signals"}
    main = {"highway": "secondary", "name": "Rue de l'Église"}
    made.way(
        "west r2", highway="secondary", name="Route de Villeneuve-l'Étang", ref="D 17", zone__traffic="FR:rural"
    )
    made.way(
        "r0 r1 r2 r3 r0", highway="secondary", junction="roundabout", oneway="yes", source__maxspeed="FR:urban"
    )
    made.way("r0 n02 n12 n22 n32 n42 n52", **main, maxspeed="50", lit="yes", lane_markings="no")
    made.way("n52 t1", **main, maxspeed="50")
    made.way("t1 t2", **main, maxspeed="50", tunnel="yes", lit="yes")
    made.way("t2 east", highway="secondary", ref="D 17", maxspeed="80")
    made.way(
        "n20 n21 n22 n23 n24", highway="tertiary", name="Rue du Lavoir", maxspeed__type="FR:urban", maxspeed="30"
    )
    for row in (0, 1, 3, 4):
        names = " ".join(f"n{column}{row}" for column in range(6))
        made.way(names, highway="residential", name=f"Rue des Prés {row}")
    for column in (0, 1, 3, 4, 5):
        names = " ".join(f"n{column}{row}" for row in range(5))
        made.way(names, highway="residential", name=f"Allée {column}", **({"oneway": "yes"} if column == 3 else {}))
    made.way("n24 ramp d2", highway="tertiary", name="Chemin du Haut")
    made.way("d1 d2 d3", highway="motorway", ref="A 99", oneway="yes", maxspeed="none")
    made.way("d4 d5 d6", highway="motorway", ref="A 99", oneway="yes", maxspeed="none")
    made.way("d5 d2", highway="motorway_link", oneway="no")
    made.way("n00 n11", highway="footway")
    made.way("n11 n22", highway="residential", access="private", name="Cour privée")
    made.area("pond", 20.0, 20.0, 60.0, natural="water")
    made.area("cistern", 20.0, 180.0, 60.0, natural="water", location="underground")
    made.area("green", 180.0, 20.0, 100.0, leisure="park")
    made.area("house", 340.0, 20.0, 12.0, building="yes")
    made.area("neighbour", 352.0, 20.0, 12.0, building="house")
    made.area("pavilion", 220.0, 60.0, 20.0, building="pavilion")
    made.area("shed", 340.0, 60.0, 3.0, building="shed")
    made.area("far", 90_000.0, 20.0, 900.0, landuse="forest")
    made.way("n00 n10 n11", natural="water")
    return made


def _write(text: str, folder: Path) -> dict[str, Path]:
    import osmium

    files = {ending: folder / f"village.osm{ending}" for ending in ("", ".gz", ".bz2", ".pbf", ".xml")}
    files[""].write_text(text, encoding="utf-8")
    files[".xml"].write_text(text, encoding="utf-8")
    files[".gz"].write_bytes(gzip.compress(text.encode()))
    files[".bz2"].write_bytes(bz2.compress(text.encode()))
    with osmium.SimpleWriter(str(files[".pbf"])) as writer:
        for item in osmium.FileProcessor(str(files[""])):
            writer.add(item)
    return files


@pytest.fixture(scope="session")
def make_village() -> Callable[[tuple[float, float]], Map]:
    return village


@pytest.fixture(scope="session")
def formats(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The village's file by ending: "", .gz, .bz2, .pbf, .xml."""
    return _write(village().xml(), tmp_path_factory.mktemp("village"))


@pytest.fixture(scope="session")
def quick() -> ImportOptions:
    """Options under which an import tries the traffic for two minutes only."""
    return ImportOptions(stable_for_min=2.0, density_per_km=0.4)


@pytest.fixture(scope="session")
def imported(
    sumo: None, formats: dict[str, Path], quick: ImportOptions, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, ImportReport]:
    """The village's scenario; not to be written to."""
    out = tmp_path_factory.mktemp("imported") / "village"
    return out, import_map(formats[".pbf"], out, quick)
