"""Fetches the roads of an area, and the ground around them, from an Overpass endpoint that the user names.

    download("https://.../api/interpreter", Area.parse("2.28,48.86,2.31,48.88"), Path("etoile.osm"))

The query and the answers follow the OSM wiki's "Overpass API/Overpass QL": a busy server answers 429 or 504, and
one that stopped halfway says so in a ``<remark>`` at the end of an otherwise valid answer. The file keeps the
server's ``<note>`` with the licence; it is written completely or not at all.
"""

from __future__ import annotations

import http.client
import re
import socket
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import IO

from automotive_cosim.contracts import Tell
from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import copy, drafted
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.land_cover import TAGS

LARGEST_KM2 = 2500.0
"""A large city. Larger areas are available as PBF extracts."""

BUILDINGS_KM2 = 50.0
"""A town. In a larger area, buildings would be most of the answer."""

BUSY = (429, 502, 503, 504)
"""Status codes after which a retry makes sense."""

FIRST_PAUSE_S = 2.0
LONGEST_PAUSE_S = 120.0
"""Pause before the second attempt; doubled each time, unless the server says how long."""

PIECE_BYTES = 1 << 16


@dataclass(frozen=True, slots=True)
class DownloadLimits:
    """How patient a download is."""

    timeout_s: float = 180.0
    """Seconds without an answer before giving up."""
    tries: int = 4
    """Maximum number of requests to a busy server."""
    size_mb: float = 500.0


@dataclass(frozen=True, slots=True)
class Download:
    """The result of a download."""

    size_mb: float
    note: str
    """The server's licence note; empty without one."""
    map_date: str
    """Date of the map data, ISO 8601; empty if the server does not say."""


class _BusyError(Exception):
    """A failure worth a retry, after a pause if the server requests one."""

    def __init__(self, why: str, pause_s: float | None = None) -> None:
        super().__init__(why)
        self.pause_s = pause_s


def query(area: Area, limits: DownloadLimits) -> str:
    """What to ask for, in Overpass QL: the roads of an area, with turn restrictions, signs, speed cameras and what
    these enforce, and zones for some cars; water and green; in an area of at most ``BUILDINGS_KM2``, buildings."""
    box = f"{area.south_deg:.7f},{area.west_deg:.7f},{area.north_deg:.7f},{area.east_deg:.7f}"
    middle = f"{(area.south_deg + area.north_deg) / 2:.7f},{(area.west_deg + area.east_deg) / 2:.7f}"
    zones = '[boundary~"^(low_emission_zone|limited_traffic_zone)$"]'
    values: dict[str, list[str]] = {}
    for keys in TAGS.values():
        for key, words in keys.items():
            values.setdefault(key, []).extend(sorted(words))
    ground = "".join(f'wr[{key}~"^({"|".join(words)})$"]({box});' for key, words in values.items())
    if area.size_km2 <= BUILDINGS_KM2:
        ground += f"wr[building]({box});"
    return (
        f"[out:xml][timeout:{limits.timeout_s:.0f}][maxsize:{limits.size_mb * 1e6:.0f}];"
        f"way[highway]({box})->.roads;"
        f"({ground})->.ground;"
        f'node[highway~"^(speed_camera|stop|give_way)$"]({box})->.cameras;'
        "rel(bn.cameras)[type=enforcement]->.watches;"
        f"is_in({middle})->.here;"
        f"(rel{zones}({box});rel(pivot.here){zones};)->.zones;"
        f'(.roads;node(w.roads);rel(bw.roads)[type~"^(restriction|connectivity)"];'
        ".cameras;.watches;node(r.watches);.zones;.ground;.ground >;);"
        "out body;"
    )


def download(
    endpoint: str,
    area: Area,
    target: Path,
    limits: DownloadLimits | None = None,
    *,
    tell: Tell = lambda _stage, _share: None,
    sleep: Callable[[float], None] = time.sleep,
) -> Download:
    """Writes the roads of an area to ``target`` as OSM XML.

    Args:
        endpoint: URL of an Overpass API's ``interpreter``.
        target: the file to create; it must not exist.
        limits: limits of time, attempts and size.

    Raises UserError: the endpoint, the area or the target cannot be used, or the server returns no map."""
    limits = limits or DownloadLimits()
    _check(endpoint, area, target)
    request = urllib.request.Request(
        endpoint,
        data=urllib.parse.urlencode({"data": query(area, limits)}).encode(),
        headers={
            "User-Agent": f"automotive-cosim/{version('automotive-cosim')}",
            "Accept": "application/osm3s+xml",
        },
    )
    try:
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-map-") as scratch:
            fetched = Path(scratch) / "answer.osm"
            _fetch_patiently(request, fetched, limits, tell, sleep)
            found = _judge(fetched, endpoint)
            copy(fetched, target, round(limits.size_mb * 1e6))
    except OSError as error:
        raise UserError(f"{target} cannot be written ({error.strerror}); choose another --out") from error
    return found


def _check(endpoint: str, area: Area, target: Path) -> None:
    parts = urllib.parse.urlsplit(endpoint)
    if parts.scheme not in ("http", "https") or not parts.netloc:
        raise UserError(
            f"{endpoint!r} is not an Overpass endpoint; give a URL that ends in /api/interpreter with --endpoint"
        )
    if area.size_km2 > LARGEST_KM2:
        raise UserError(
            f"the area has {area.size_km2:.0f} km2, more than the {LARGEST_KM2:.0f} that a server should be "
            "asked for; give a smaller --bbox, or download an extract and crop it with `scenarios import --bbox`"
        )
    if target.exists():
        raise UserError(f"{target} exists; choose another --out")


def _fetch_patiently(
    request: urllib.request.Request,
    target: Path,
    limits: DownloadLimits,
    tell: Tell,
    sleep: Callable[[float], None],
) -> None:
    pause_s = FIRST_PAUSE_S
    for left in range(limits.tries - 1, -1, -1):
        try:
            _fetch(request, target, limits, tell)
        except _BusyError as error:
            if not left:
                times = "once" if limits.tries == 1 else f"{limits.tries} times"
                raise UserError(
                    f"{request.full_url} returned no map, asked {times}: {error}; try later, or another --endpoint"
                ) from error
            wait_s = min(LONGEST_PAUSE_S, error.pause_s or pause_s)
            tell(f"{error}; trying again in {wait_s:.0f} s", None)
            sleep(wait_s)
            pause_s *= 2
        else:
            return


def _fetch(request: urllib.request.Request, target: Path, limits: DownloadLimits, tell: Tell) -> None:
    tell("asking the server", None)
    try:
        with urllib.request.urlopen(request, timeout=limits.timeout_s) as answer, drafted(target) as file:
            _copy(answer, file, limits, tell)
    except urllib.error.HTTPError as error:
        with error:
            text = _words(error.read(PIECE_BYTES).decode("utf-8", "replace"))
            after = error.headers.get("Retry-After", "")
        if error.code in BUSY:
            raise _BusyError(
                f"it is busy (HTTP {error.code})", float(after) if after.isdigit() else None
            ) from error
        raise UserError(f"{request.full_url} refuses (HTTP {error.code}): {text}") from error
    except TimeoutError as error:
        raise _BusyError(f"no answer in {limits.timeout_s:g} s") from error
    except urllib.error.URLError as error:
        if isinstance(error.reason, TimeoutError):
            raise _BusyError(f"no answer in {limits.timeout_s:g} s") from error
        if isinstance(error.reason, socket.gaierror):
            raise UserError(f"{request.full_url}: no such host; is there a network?") from error
        raise _BusyError(f"it cannot be reached ({error.reason})") from error
    except (http.client.HTTPException, ConnectionError) as error:
        raise _BusyError(f"the connection broke ({type(error).__name__})") from error


def _copy(answer: http.client.HTTPResponse, file: IO[bytes], limits: DownloadLimits, tell: Tell) -> None:
    size = 0
    while piece := answer.read(PIECE_BYTES):
        size += len(piece)
        if size > limits.size_mb * 1e6:
            raise UserError(f"the map is larger than {limits.size_mb:g} MB; give a smaller --bbox or --max-mb")
        file.write(piece)
        tell(f"receiving, {size / 1e6:.1f} MB", None)
    if size < int(answer.headers.get("Content-Length", 0)):
        raise _BusyError("the connection broke")


def _judge(file: Path, endpoint: str) -> Download:
    """Checks that an answer is a complete map. Raises UserError: it is not."""
    size = file.stat().st_size
    with file.open("rb") as stream:
        head = stream.read(4096).decode("utf-8", "replace")
        stream.seek(max(0, size - 4096))
        tail = stream.read().decode("utf-8", "replace")
    if "<osm" not in head:
        raise UserError(
            f"{endpoint} did not answer with a map but with {_words(head) or 'nothing'!r}; is it an Overpass API?"
        )
    remark = re.search(r"<remark>(.*?)</remark>", tail, re.DOTALL)
    if remark:
        raise UserError(f"the server stopped: {_words(remark[1])}; give a smaller --bbox")
    if not tail.rstrip().endswith("</osm>"):
        raise UserError(f"the answer from {endpoint} is truncated after {size / 1e6:.1f} MB; try again")
    note = re.search(r"<note>(.*?)</note>", head, re.DOTALL)
    date = re.search(r'<meta [^>]*osm_base="([^"]*)"', head)
    return Download(size / 1e6, _words(note[1]) if note else "", date[1] if date else "")


def _words(markup: str) -> str:
    """The text of a page, on one line, short."""
    body = re.sub(r"<(script|style|head)\b.*?</\1>", " ", markup, flags=re.DOTALL | re.IGNORECASE)
    text = " ".join(re.sub(r"<[^>]*>", " ", body).split())
    return text if len(text) <= 300 else f"{text[:297]}..."
