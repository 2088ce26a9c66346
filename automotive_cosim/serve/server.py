"""The web server: a fixed table of routes, which only read, except for playing.

The address with its token gives access; the token is then swapped for a cookie that other sites cannot use.
The standard library's server suffices: a page asks for a second of road or a picture at a time, and every answer
takes a few milliseconds.
"""

from __future__ import annotations

import gzip
import hmac
import json
import mimetypes
import re
import secrets
import socket
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from enum import StrEnum
from http import HTTPStatus
from http.client import LineTooLong
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any
from urllib.parse import parse_qs, unquote, urlsplit

from automotive_cosim import __version__
from automotive_cosim.contracts import Json
from automotive_cosim.errors import CosimError, UnknownNameError, UserError
from automotive_cosim.formats.files import parse_json, read_bytes
from automotive_cosim.formats.layout import road_view, screenshot
from automotive_cosim.safety.page import PAGE
from automotive_cosim.serve import catalogue
from automotive_cosim.serve.content import Content
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.records import NotHereError, RecordFolders
from automotive_cosim.serve.study import PeopleStudy
from automotive_cosim.service.own_names import ANY, is_own, own_names

SECURITY = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "media-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
ALONE = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'; sandbox"
)
"""The policy of a page from a file, which anybody may have made."""
MOST_BYTES = 10_000
"""Longest request body that is read."""
MOST_HEAD_BYTES = 2**15
"""Longest request line and headers."""
MOST_CONNECTIONS = 256
"""At once, each with a thread. One more ends the oldest of those who have shown the least."""
STRANGER_S = 10.0
"""How long a connection may stay without a request that has the token."""
WAIT_S = 1.0
"""How long an answer waits for something to happen in a game."""
SMALL_BYTES = 1000
"""Shorter answers are not worth compressing."""


@dataclass(frozen=True, slots=True)
class WebAnswer:
    """A response to the browser."""

    body: bytes
    kind: str = "application/json"
    keep_s: int = 0
    """How long the browser may reuse it without asking."""
    is_alone: bool = False
    """Whether it is a page by itself, from a file: it may bring styles and pictures, and runs nothing."""


class _RefusedRequestError(Exception):
    """A request that is not answered, and why."""

    def __init__(self, status: HTTPStatus, why: str) -> None:
        super().__init__(why)
        self.status = status


WebRoute = Callable[[Mapping[str, str], Mapping[str, str]], WebAnswer]
"""Parts of the path and of the query, to an answer."""
_Routes = list[tuple[re.Pattern[str], WebRoute]]


class Visitor(StrEnum):
    """Who asks, by the token."""

    OWNER = "owner"
    """The person who started the server: sees everything."""
    PERSON = "person"
    """A participant of a study: sees no task, no record and nobody's verdicts."""


class Site:
    """The routes and their data."""

    def __init__(self, folders: list[Path], game: Game | None = None, study: PeopleStudy | None = None) -> None:
        """Reads the static files.

        Args:
            game: lets a person play; None if playing is off.
            study: deals episodes to several people; None if there is none.

        Raises UserError: a folder does not exist."""
        self._game = game
        self._study = study
        self._content = Content(RecordFolders(folders))
        self.first_page = self._content.first_page
        static = Path(str(files("automotive_cosim.serve") / "static"))
        self._static = {path.name: path.read_bytes() for path in static.iterdir() if path.is_file()}
        run, episode = r"(?P<run>[0-9a-f]{12})", r"(?:/episodes/(?P<episode>[\w.+-]+))?"
        content = self._content
        self._for_everybody: _Routes = [
            (re.compile(pattern), route)
            for pattern, route in (
                (r"/", lambda _, __: self._file("index.html")),
                (r"/static/(?P<name>[\w.-]+)", lambda path, _: self._file(path["name"])),
                (r"/api/study", lambda _, __: _json(self._studied.overview())),
                (r"/api/study/seat", lambda _, query: _json(self._studied.turn(query.get("seat", "")))),
                (r"/api/study/play", lambda _, query: self._scene(self._seat_of(query), query)),
                (r"/api/study/play/screen", lambda _, query: _screen(self._seat_of(query))),
            )
        ]
        self._routes: _Routes = [
            (re.compile(pattern), route)
            for pattern, route in (
                (r"/api/play", lambda _, query: self._scene(self._own_game, query)),
                (r"/api/play/screen", lambda _, __: _screen(self._own_game)),
                (r"/api/study/seen", lambda _, __: _json(self._studied.seen())),
                (r"/api/study/rows\.(?P<kind>csv|json)", self._rows),
                (r"/api/runs", lambda _, __: _json(content.runs())),
                (rf"/api/runs/{run}{episode}", lambda path, _: _json(content.run(path["run"], path["episode"]))),
                (
                    rf"/api/runs/{run}{episode}/steps",
                    lambda path, query: _json(content.steps(path["run"], path["episode"], _number(query))),
                ),
                (
                    rf"/api/runs/{run}{episode}/road",
                    lambda path, query: _json(
                        {"lines": list(content.road(path["run"], path["episode"], _number(query)))}
                    ),
                ),
                (rf"/api/runs/{run}{episode}/(?P<of>pictures|views)/(?P<step>\d{{1,6}})", self._picture),
                (
                    rf"/api/runs/{run}{episode}/sounds/(?P<step>\d{{1,6}})/(?P<number>\d{{1,3}})",
                    lambda path, _: WebAnswer(
                        content.sound(path["run"], path["episode"], int(path["step"]), int(path["number"])),
                        "audio/wav",
                        60,
                    ),
                ),
                (rf"/api/evaluations/{run}", lambda path, _: _json(content.evaluation(path["run"]))),
                (rf"/api/evaluations/{run}/search\.html", lambda path, _: self._findings(path["run"])),
                (rf"/api/studies/{run}", lambda path, _: _json(content.study(path["run"], ""))),
                (rf"/api/studies/{run}/live", lambda path, _: _json(content.watched_study(path["run"]))),
                (
                    rf"/api/studies/{run}/(?P<part>\w+)/(?P<item>[\w.+-]+)",
                    lambda path, _: _json(content.study(path["run"], path["part"], path["item"])),
                ),
                (r"/api/tasks", lambda _, __: _json(catalogue.tasks())),
                (r"/api/tasks/(?P<name>[\w-]+)", lambda path, _: _json(catalogue.task(path["name"]))),
                (r"/api/tasks/(?P<name>[\w-]+)/reference", lambda path, _: _json(content.reference(path["name"]))),
                (r"/api/drives", lambda _, __: _json(catalogue.drives())),
                (r"/api/scenarios", lambda _, __: _json(catalogue.all_scenarios())),
                (r"/api/scenarios/(?P<name>[\w-]+)/map", _map),
            )
        ]

    def answer(self, path: str, query: Mapping[str, str], visitor: Visitor = Visitor.OWNER) -> WebAnswer:
        """The answer to a path.

        Raises _RefusedRequestError: there is no such page, it is not for this visitor, or it cannot be made."""
        if path == "/api/about":
            about = {"version": __version__, "plays": self._game is not None, "visitor": visitor}
            return _json(about | {"study": self._study and self._study.name})
        routes: _Routes = self._for_everybody + (self._routes if visitor is Visitor.OWNER else [])
        for pattern, route in routes:
            found = pattern.fullmatch(path)
            if found:
                try:
                    return route(found.groupdict(), query)
                except (NotHereError, UnknownNameError) as error:
                    raise _RefusedRequestError(HTTPStatus.NOT_FOUND, str(error)) from error
                except (CosimError, OSError, ValueError, LookupError, TypeError, AttributeError) as error:
                    why = f"this record cannot be read: {error}"
                    raise _RefusedRequestError(HTTPStatus.UNPROCESSABLE_ENTITY, why) from error
        raise _RefusedRequestError(HTTPStatus.NOT_FOUND, "there is no such page")

    def change(self, path: str, query: Mapping[str, str], body: bytes, visitor: Visitor) -> WebAnswer:
        """Carries out a player's request.

        Raises _RefusedRequestError: there is no such action, or it is not possible now."""
        is_study = path.startswith("/api/study/") and self._study is not None
        is_play = path.startswith("/api/play/") and self._game is not None and visitor is Visitor.OWNER
        if not is_study and not is_play:
            raise _RefusedRequestError(HTTPStatus.METHOD_NOT_ALLOWED, "these pages are read-only")
        try:
            asked = parse_json(body or b"{}")
            if not isinstance(asked, dict):
                raise UserError("the request body is not a JSON object; send one")
            what = path.rpartition("/")[2]
            if is_study and path.count("/") == 3:
                return _json(self._take_part(what, query, asked))
            game = self._own_game if is_play else self._seat_of(query)
            return self._play(what, game, asked, is_free=is_play)
        except (UserError, ValueError, ArithmeticError) as error:
            raise _RefusedRequestError(HTTPStatus.UNPROCESSABLE_ENTITY, str(error)) from error

    def _play(self, what: str, game: Game, asked: Json, *, is_free: bool) -> WebAnswer:
        """One episode; people in a study can neither choose it nor stop its clock."""
        match what:
            case "act":
                return WebAnswer(game.act(asked), "image/jpeg")
            case "leave":
                game.leave()
            case "start" if is_free:
                _start(game, asked)
            case "pace" if is_free:
                speed = asked.get("speed", 1)
                if not isinstance(speed, (int, float)):
                    raise UserError("speed must be a number")
                game.pace(float(speed), paused=bool(asked.get("paused")))
            case _:
                raise _RefusedRequestError(HTTPStatus.METHOD_NOT_ALLOWED, "there is no such thing to do")
        return _json({})

    def _take_part(self, what: str, query: Mapping[str, str], asked: Json) -> Json:
        study, seat = self._studied, query.get("seat", "")
        match what:
            case "join":
                return {"seat": study.join(str(asked.get("name", "")), str(asked.get("seat", "")))}
            case "begin":
                study.begin(seat)
            case "answer":
                study.answer(seat, asked)
            case "detected":
                study.detect(seat, asked)
            case _:
                raise _RefusedRequestError(HTTPStatus.METHOD_NOT_ALLOWED, "there is no such thing to do")
        return {}

    def close(self) -> None:
        """Ends game and study, and stops watching."""
        self._content.observers.close()
        if self._game is not None:
            self._game.close()
        if self._study is not None:
            self._study.close()

    @property
    def _studied(self) -> PeopleStudy:
        if self._study is None:
            raise NotHereError("there is no study here; start `automotive-cosim serve --study FILE`")
        return self._study

    def _seat_of(self, query: Mapping[str, str]) -> Game:
        """The game of a participant, who is never given another one."""
        return self._studied.seat(query.get("seat", "")).game

    @property
    def _own_game(self) -> Game:
        if self._game is None:
            raise NotHereError("playing is off here; start `automotive-cosim serve --play`")
        return self._game

    def _rows(self, path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
        if path["kind"] == "json":
            return _json(self._studied.export())
        return WebAnswer(self._studied.as_csv().encode(), "text/csv")

    def _scene(self, game: Game, query: Mapping[str, str]) -> WebAnswer:
        """The newest scene, or after a while the same one if nothing happens."""
        scene = game.scene(_number(query), WAIT_S) if "seen" in query else game.scene()
        shown = {"version": scene.version, "state": scene.state, "progress": scene.progress, "error": scene.error}
        shown |= {"practice": scene.is_practice, "paused": scene.is_paused, "speed": scene.speed}
        shown |= {"look": scene.look, "told": scene.told}
        if game is self._game:
            record = None if scene.folder is None else self._content.records.of(scene.folder).id
            shown |= {"record": record, "episode": scene.episode}
        return _json(shown)

    def _file(self, name: str) -> WebAnswer:
        if name not in self._static:
            raise NotHereError("there is no such file")
        return WebAnswer(self._static[name], mimetypes.guess_type(name)[0] or "application/octet-stream")

    def _findings(self, name: str) -> WebAnswer:
        """The page of a search."""
        records = self._content.records
        page = records.file(records.entry(name), PAGE)
        return WebAnswer(read_bytes(page), "text/html", is_alone=True)

    def _picture(self, path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
        records = self._content.records
        entry = records.entry(path["run"])
        of = road_view if path["of"] == "views" else screenshot
        picture = records.picture(entry, records.trial(entry, path["episode"]), int(path["step"]), of)
        return WebAnswer(read_bytes(picture), "image/jpeg", 60)


_RANKS = {Visitor.PERSON: 1, Visitor.OWNER: 2}
"""Whose connections are ended last."""


class WebServer(ThreadingHTTPServer):
    """Serves a site to anyone with its token."""

    daemon_threads = True
    request_queue_size = 128  # of five, the rest of a burst is tried again after seconds

    def __init__(
        self,
        folders: list[Path],
        host: str = "127.0.0.1",
        port: int = 0,
        game: Game | None = None,
        study: PeopleStudy | None = None,
    ) -> None:
        """Binds the address.

        Args:
            game: lets a person play; None if playing is off. The server closes it.
            study: deals episodes to several people. The server closes it.
            port: port to listen on; 0 takes a free one.

        Raises UserError: a folder does not exist, or the address cannot be used."""
        self.site = Site(folders, game, study)
        self.token = secrets.token_urlsafe(24)
        self.people_token = secrets.token_urlsafe(24)
        self.host = host
        if ":" in host:
            self.address_family = socket.AF_INET6
        try:
            super().__init__((host, port), _RequestHandler)
        except (OSError, OverflowError) as error:
            why = getattr(error, "strerror", None) or str(error)
            raise UserError(
                f"cannot listen on {host} port {port}: {why}; give another address with --http"
            ) from error
        self.names = own_names(host)
        self._held: dict[socket.socket, tuple[int, float]] = {}
        """Rank and time of each connection: 0 before it has shown a token."""
        self._holding = threading.Lock()

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Makes room for a connection, or refuses it if all others have shown as much as can be."""
        with self._holding:
            if len(self._held) >= MOST_CONNECTIONS:
                oldest = min(self._held, key=self._held.__getitem__)
                if self._held[oldest][0] == max(_RANKS.values()):
                    return False
                self._end(oldest)
            self._held[request] = 0, time.monotonic()
        return True

    def note(self, request: socket.socket, visitor: Visitor) -> None:
        """A connection has shown a token."""
        with self._holding:
            if request in self._held:
                self._held[request] = _RANKS[visitor], time.monotonic()

    def service_actions(self) -> None:
        """Ends connections that have shown nothing for too long, whatever comes on them."""
        late_s = time.monotonic() - STRANGER_S
        with self._holding:
            for request, (rank, since_s) in [*self._held.items()]:
                if not rank and since_s < late_s:
                    self._end(request)

    def _end(self, request: socket.socket) -> None:
        """Wakes the thread of a connection, which closes it."""
        del self._held[request]
        with suppress(OSError):
            request.shutdown(socket.SHUT_RDWR)

    def shutdown_request(self, request: Any) -> None:
        """Closes a connection."""
        with self._holding:
            self._held.pop(request, None)
        super().shutdown_request(request)

    @property
    def address(self) -> str:
        """The address to open in a browser, including the token."""
        return self._address(self.token, self.site.first_page())

    @property
    def people_address(self) -> str:
        """The address for the participants of the study."""
        return self._address(self.people_token, "#/study")

    def _address(self, token: str, page: str) -> str:
        host = socket.gethostname() if self.host in ANY else self.host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.server_port}/?token={token}{page}"

    def server_close(self) -> None:
        """Frees the port and ends a game."""
        super().server_close()
        self.site.close()

    def handle_error(self, request: object, client_address: object) -> None:
        """Prints nothing: a browser that disconnects is not an error."""


class _Heads:
    """What comes on a connection, of which only so much may be lines of a head."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self.left = MOST_HEAD_BYTES

    def readline(self, size: int = -1, /) -> bytes:
        """A line of a head. Raises LineTooLong: the head is longer than it may be."""
        line = self._file.readline(min(size, self.left + 1) if size >= 0 else self.left + 1)
        self.left -= len(line)
        if self.left < 0:
            raise LineTooLong("head")
        return line

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)


class _RequestHandler(BaseHTTPRequestHandler):
    """Handles one HTTP request."""

    protocol_version = default_request_version = "HTTP/1.1"
    server_version, sys_version = "automotive-cosim", ""
    timeout = 60
    disable_nagle_algorithm = True
    """A body does not wait until the browser has acknowledged the headers."""

    def setup(self) -> None:
        super().setup()
        self.rfile = _Heads(self.rfile)  # type: ignore[assignment, arg-type]

    def handle_one_request(self) -> None:
        """Begins with another head."""
        self.rfile.left = MOST_HEAD_BYTES  # type: ignore[attr-defined]
        try:
            super().handle_one_request()
        except LineTooLong:
            self.requestline = self.command = ""
            self.request_version = self.protocol_version
            self.send_error(HTTPStatus.REQUEST_URI_TOO_LONG)
            self.close_connection = True

    def do_GET(self) -> None:
        """Answers, or sends the reason for refusing."""
        with self._refusing(is_data=self.path.startswith("/api/")):
            path, query, visitor = self._request()
            if query.get("token"):
                self._welcome(query["token"])
                return
            self._send(HTTPStatus.OK, self._web.site.answer(path, query, visitor))

    def do_HEAD(self) -> None:
        self.do_GET()

    def do_POST(self) -> None:
        """Does something in a game; nothing else here can be changed."""
        with self._refusing(is_data=True):
            path, query, visitor = self._request()
            if self.headers.get("Origin") is None:
                raise _RefusedRequestError(HTTPStatus.FORBIDDEN, "only the pages themselves may do this")
            length = self.headers.get("Content-Length", "")
            if not re.fullmatch("[0-9]{1,9}", length) or int(length) > MOST_BYTES:
                raise _RefusedRequestError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"give at most {MOST_BYTES} bytes")
            self._send(HTTPStatus.OK, self._web.site.change(path, query, self.rfile.read(int(length)), visitor))

    @contextmanager
    def _refusing(self, *, is_data: bool) -> Iterator[None]:
        """Answers with the reason whatever is refused, or cannot be answered as it came."""
        try:
            yield
        except OSError:  # the connection has gone
            raise
        except Exception as error:
            refused = isinstance(error, _RefusedRequestError)
            status = error.status if isinstance(error, _RefusedRequestError) else HTTPStatus.BAD_REQUEST
            why = str(error) if refused else f"this cannot be answered: {type(error).__name__}"
            self.close_connection |= self.command == "POST"  # the body may not have been read
            self._send(status, _json({"error": why}) if is_data else WebAnswer(f"{why}\n".encode(), "text/plain"))

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 (its name in the base class)
        """Silences the base class, which would print every request."""

    @property
    def _web(self) -> WebServer:
        assert isinstance(self.server, WebServer)
        return self.server

    def _request(self) -> tuple[str, dict[str, str], Visitor]:
        """The path, the query and the visitor of a request that may be answered.

        Raises _RefusedRequestError: it comes from elsewhere, or without the token."""
        host = self.headers.get("Host", "")
        if not is_own(host, self._web.names, self._web.server_port):
            raise _RefusedRequestError(
                HTTPStatus.BAD_REQUEST, "this server has another name; open the address that it printed"
            )
        origin = self.headers.get("Origin")
        if origin is not None and origin != f"http://{host}":
            raise _RefusedRequestError(HTTPStatus.FORBIDDEN, "other sites may not read this")
        parts = urlsplit(self.path)
        query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
        given = query.get("token") or self._cookie()
        for token, visitor in ((self._web.token, Visitor.OWNER), (self._web.people_token, Visitor.PERSON)):
            if hmac.compare_digest(given.encode(), token.encode()):
                self._web.note(self.connection, visitor)
                return unquote(parts.path), query, visitor
        raise _RefusedRequestError(
            HTTPStatus.FORBIDDEN, "the token is missing or wrong; open the address that the server printed"
        )

    def _cookie(self) -> str:
        pairs = (pair.strip().partition("=") for pair in self.headers.get("Cookie", "").split(";"))
        return next((value for name, _, value in pairs if name == self._cookie_name), "")

    @property
    def _cookie_name(self) -> str:
        return f"automotive_cosim_{self._web.server_port}"

    def _welcome(self, token: str) -> None:
        """Swaps the token in the address for a cookie; the browser keeps the page after the ``#``."""
        self.send_response(HTTPStatus.SEE_OTHER)
        self.send_header("Location", "/")
        cookie = f"{self._cookie_name}={token}; HttpOnly; SameSite=Strict; Path=/"
        self.send_header("Set-Cookie", cookie)
        self._end(b"")

    def _send(self, status: HTTPStatus, answer: WebAnswer) -> None:
        body = answer.body
        self.send_response(status)
        is_text = not answer.kind.startswith(("image/", "audio/"))
        self.send_header("Content-Type", answer.kind + ("; charset=utf-8" if is_text else ""))
        self.send_header("Cache-Control", f"private, max-age={answer.keep_s}" if answer.keep_s else "no-store")
        if is_text and len(body) > SMALL_BYTES and "gzip" in self.headers.get("Accept-Encoding", ""):
            body = gzip.compress(body, compresslevel=4, mtime=0)
            self.send_header("Content-Encoding", "gzip")
        self._end(body, {"Content-Security-Policy": ALONE} if answer.is_alone else {})

    def _end(self, body: bytes, own: Mapping[str, str] = MappingProxyType({})) -> None:
        for name, value in {**SECURITY, **own}.items():
            self.send_header(name, value)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)


def _screen(game: Game) -> WebAnswer:
    screen = game.scene().screen
    if not screen:
        raise NotHereError("there is no screen now")
    return WebAnswer(screen, "image/jpeg")


def _start(game: Game, asked: Json) -> None:
    """Begins what is requested: a drive if one is given, else a task."""
    given = {name: asked.get(name, "") for name in ("task", "half", "drive", "name")}
    seed, practice = asked.get("seed", 0), bool(asked.get("practice"))
    if not all(isinstance(value, str) for value in given.values()) or type(seed) is not int:
        raise UserError("task, half, drive and name must be strings, and seed a whole number")
    if not 0 <= seed < 2**31:
        raise UserError(f"seed {seed} is not a whole number from 0 to {2**31 - 1}")
    if given["drive"]:
        game.drive(given["drive"], seed, given["name"], practice=practice)
    else:
        game.start(given["task"], given["half"], seed, given["name"], practice=practice)


def _number(query: Mapping[str, str]) -> int:
    text = query.get("skip", query.get("seen", "0"))
    if not text.isdecimal() or len(text) > 9:
        raise NotHereError(f"skip={text!r} is not a whole number from 0")
    return int(text)


def _map(path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
    return WebAnswer(catalogue.scenario_map(path["name"]).read_bytes(), "image/webp", 3600)


def _json(value: object) -> WebAnswer:
    return WebAnswer(json.dumps(value, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "replace"))
