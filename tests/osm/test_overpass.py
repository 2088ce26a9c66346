"""Maps are fetched from a server that the user names; here one that stands in for it on this machine."""

import threading
import urllib.parse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from typer.testing import CliRunner

from automotive_cosim.cli.scenarios import app
from automotive_cosim.errors import UserError
from automotive_cosim.osm import extract
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.overpass import FIRST_PAUSE_S, LONGEST_PAUSE_S, DownloadLimits, download, query

AREA = Area(1.58, 48.29, 1.64, 48.32)
NOTE = "The data included in this document is from www.openstreetmap.org. The data is made available under ODbL."
HEAD = f'<osm version="0.6" generator="stand-in"><note>{NOTE}</note><meta osm_base="2026-11-20T03:04:05Z"/>'

Answer = Callable[[BaseHTTPRequestHandler], None]


@dataclass
class Server:
    url: str
    answers: list[Answer]
    """One a request; the last one for all that follow."""
    asked: list[str] = field(default_factory=list)
    """The queries."""


@pytest.fixture
def server() -> Iterator[Server]:
    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            form = self.rfile.read(int(self.headers["Content-Length"])).decode()
            made.asked.append(urllib.parse.parse_qs(form)["data"][0])
            made.answers[min(len(made.asked), len(made.answers)) - 1](self)

        def log_message(self, *args: object) -> None:
            """Nobody reads it."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as http_server:
        made = Server(f"http://127.0.0.1:{http_server.server_address[1]}/api/interpreter", [])
        thread = threading.Thread(target=http_server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield made
        http_server.shutdown()
        thread.join()


@pytest.fixture
def whole(formats: dict[str, Path]) -> str:
    """The village, as a server writes it."""
    text = formats[""].read_text(encoding="utf-8")
    return text.replace('<osm version="0.6">', HEAD)


def says(text: str, status: int = 200, **headers: str) -> Answer:
    def answer(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(status)
        for name, value in headers.items():
            handler.send_header(name.replace("_", "-"), value)
        handler.end_headers()
        handler.wfile.write(text.encode())

    return answer


def falls_silent(handler: BaseHTTPRequestHandler) -> None:
    handler.send_response(200)
    handler.end_headers()
    handler.wfile.write(b"<osm>")
    handler.wfile.flush()
    threading.Event().wait(0.6)


def breaks_off(handler: BaseHTTPRequestHandler) -> None:
    handler.send_response(200)
    handler.send_header("Content-Length", "100000")
    handler.end_headers()
    handler.wfile.write(b"<osm>")


def test_the_map_is_the_servers_with_its_licence(server: Server, whole: str, tmp_path: Path) -> None:
    server.answers = [says(whole)]
    target = tmp_path / "village.osm"
    found = download(server.url, AREA, target)
    assert target.read_text(encoding="utf-8") == whole
    assert (found.note, found.map_date) == (NOTE, "2026-11-20T03:04:05Z")
    assert found.size_mb == pytest.approx(len(whole.encode()) / 1e6)
    assert extract.read(target).ways
    assert [path.name for path in tmp_path.iterdir()] == ["village.osm"]
    (asked,) = server.asked
    assert "(48.2900000,1.5800000,48.3200000,1.6400000)" in asked, "south, west, north, east"
    assert "[timeout:180]" in asked
    for wanted in ("speed_camera", "give_way", "low_emission_zone", "is_in(48.3050000,1.6100000)", "connectivity"):
        assert wanted in asked


def test_a_busy_server_is_asked_again_after_the_pause_it_names(server: Server, whole: str, tmp_path: Path) -> None:
    server.answers = [says("", 429, Retry_After="7"), says("", 504), says("", 429, Retry_After="9999"), says(whole)]
    pauses: list[float] = []
    told: list[str] = []
    download(
        server.url, AREA, tmp_path / "map.osm", tell=lambda stage, _share: told.append(stage), sleep=pauses.append
    )
    assert pauses == [7.0, 2 * FIRST_PAUSE_S, LONGEST_PAUSE_S]
    assert len(server.asked) == 4
    assert "it is busy (HTTP 429); trying again in 7 s" in told


@pytest.mark.parametrize(
    ("answer", "said", "asked"),
    [
        (says("<html><body>Too <b>many</b></body></html>", 429), r"asked 2 times: it is busy \(HTTP 429\)", 2),
        (falls_silent, r"no answer in 0.3 s", 2),
        (breaks_off, "the connection broke", 2),
        (says("<html><head><title>x</title></head><body>parse <b>error</b></body></html>", 400), "parse error", 1),
        (says("<html><body>Welcome</body></html>"), "with 'Welcome'; is it an Overpass API", 1),
        (says(""), "with 'nothing'", 1),
        (says(f"{HEAD}<node id='1'/>"), "is truncated after", 1),
        (
            says(f"{HEAD}<remark> runtime error: Query timed out </remark></osm>"),
            "the server stopped: runtime error: Query",
            1,
        ),
        (says(HEAD + " " * 200_000 + "</osm>"), "larger than 0.1 MB", 1),
    ],
    ids=["busy", "silent", "broken", "refused", "page", "empty", "cut", "remark", "large"],
)
def test_what_is_no_whole_map_is_told_and_leaves_nothing(
    answer: Answer, said: str, asked: int, server: Server, tmp_path: Path
) -> None:
    server.answers = [answer]
    limits = DownloadLimits(timeout_s=0.3, tries=2, size_mb=0.1)
    with pytest.raises(UserError, match=said) as error:
        download(server.url, AREA, tmp_path / "map.osm", limits, sleep=lambda _s: None)
    assert "\n" not in str(error.value)
    assert len(server.asked) == asked
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("endpoint", "bbox", "said"),
    [
        ("ftp://x/y", "1,48,1.1,48.1", "is not an Overpass endpoint"),
        ("nonsense", "1,48,1.1,48.1", "is not an Overpass endpoint"),
        ("http://127.0.0.1:9/", "0,40,9,49", "more than the 2500"),
        ("http://127.0.0.1:9/", "1,48,1.1,48.1", "cannot be reached"),
        ("http://127.0.0.1:9/", "1,48,1,48.1", "is not an area on earth"),
        ("http://127.0.0.1:9/", "1,48,nan,49", "is not an area on earth"),
        ("http://127.0.0.1:9/", "179,-17,-179,-16", r"over the 180th meridian.*: 179,-17,180,-16 or -180,"),
        ("http://127.0.0.1:9/", "1,48,2", "is not an area on earth"),
        ("http://127.0.0.1:9/", "1,48,2,91", "is not an area on earth"),
    ],
)
def test_what_cannot_be_asked_for(endpoint: str, bbox: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match=said):
        download(endpoint, Area.parse(bbox), tmp_path / "map.osm", DownloadLimits(tries=1))
    with pytest.raises(UserError, match="exists"):
        download("http://127.0.0.1:9/", AREA, tmp_path)


def test_the_command(server: Server, whole: str, tmp_path: Path) -> None:
    server.answers = [says(whole)]
    out = tmp_path / "village.osm"
    arguments = ["download", "--bbox", "1.58,48.29,1.64,48.32", "--out", str(out)]
    done = CliRunner().invoke(app, arguments, env={"AUTOMOTIVE_COSIM_OVERPASS": server.url})
    assert done.exit_code == 0, done.output
    assert "OpenStreetMap contributors" in done.stdout
    assert NOTE in done.stdout
    assert "2026-11-20" in done.stdout
    assert out.is_file()
    assert CliRunner().invoke(app, arguments, env={"AUTOMOTIVE_COSIM_OVERPASS": ""}).exit_code == 2


def test_a_query_asks_for_the_ground_and_for_buildings_of_a_town_only() -> None:
    town, county = (query(Area(2.0, 48.0, 2.0 + side, 48.0 + side), DownloadLimits()) for side in (0.05, 0.4))
    for asked in (town, county):
        assert asked.count("(") == asked.count(")")
        assert 'wr[natural~"^(' in asked
        assert ".ground >;" in asked
    assert "wr[building](" in town
    assert "building" not in county
