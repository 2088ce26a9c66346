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
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from urllib.parse import parse_qs, unquote, urlsplit

from automotive_cosim import __version__
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.files import parse_json, read_bytes
from automotive_cosim.safety.page import PAGE
from automotive_cosim.serve import catalogue
from automotive_cosim.serve.content import Content
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.records import NotHereError, RecordFolders
from automotive_cosim.serve.study import PeopleStudy
from automotive_cosim.service.own_names import ANY, is_own, own_names

SECURITY = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
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
            folders: what to show.
            game: lets a person play; None if playing is off.
            study: deals episodes to several people; None if there is none.

        Raises:
            UserError: a folder does not exist.
        """
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
                (r"/api/study/play", self._scene),
                (r"/api/study/play/screen", self._screen),
            )
        ]
        self._routes: _Routes = [
            (re.compile(pattern), route)
            for pattern, route in (
                (r"/api/play", self._scene),
                (r"/api/play/screen", self._screen),
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
                (rf"/api/runs/{run}{episode}/pictures/(?P<step>\d{{1,6}})", self._picture),
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

        Raises:
            _RefusedRequestError: there is no such page, it is not for this visitor, or it cannot be made.
        """
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
                except (UserError, OSError, ValueError, LookupError, TypeError, AttributeError) as error:
                    why = f"this record cannot be read: {error}"
                    raise _RefusedRequestError(HTTPStatus.UNPROCESSABLE_ENTITY, why) from error
        raise _RefusedRequestError(HTTPStatus.NOT_FOUND, "there is no such page")

    def change(self, path: str, query: Mapping[str, str], body: bytes, visitor: Visitor) -> WebAnswer:
        """Carries out a player's request.

        Raises:
            _RefusedRequestError: there is no such action, or it is not possible now.
        """
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
            return self._play(what, self._game_of(query), asked, is_free=is_play)
        except (UserError, ValueError) as error:
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

    def _game_of(self, query: Mapping[str, str]) -> Game:
        """The game of a seat of the study; without a seat, that of `--play`."""
        if "seat" in query:
            return self._studied.seat(query["seat"]).game
        if self._game is None:
            raise NotHereError("playing is off here; start `automotive-cosim serve --play`")
        return self._game

    def _rows(self, path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
        if path["kind"] == "json":
            return _json(self._studied.export())
        return WebAnswer(self._studied.as_csv().encode(), "text/csv")

    def _scene(self, path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
        """The newest scene, or after a while the same one if nothing happens."""
        game = self._game_of(query)
        scene = game.scene(_number(query), WAIT_S) if "seen" in query else game.scene()
        shown = {"version": scene.version, "state": scene.state, "progress": scene.progress, "error": scene.error}
        shown |= {"practice": scene.is_practice, "paused": scene.is_paused, "speed": scene.speed}
        shown |= {"look": scene.look, "told": scene.told}
        if "seat" not in query:
            record = None if scene.folder is None else self._content.records.of(scene.folder).id
            shown |= {"record": record, "episode": scene.episode}
        return _json(shown)

    def _screen(self, path: Mapping[str, str], query: Mapping[str, str]) -> WebAnswer:
        screen = self._game_of(query).scene().screen
        if not screen:
            raise NotHereError("there is no screen now")
        return WebAnswer(screen, "image/jpeg")

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
        picture = records.picture(entry, records.trial(entry, path["episode"]), int(path["step"]))
        return WebAnswer(read_bytes(picture), "image/jpeg", 60)


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
            folders: what to show.
            game: lets a person play; None if playing is off. The server closes it.
            study: deals episodes to several people. The server closes it.
            host: address to listen on.
            port: port to listen on; 0 takes a free one.

        Raises:
            UserError: a folder does not exist, or the address cannot be used.
        """
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
            raise UserError(f"cannot listen on {host} port {port}: {why}; give another --host or --port") from error
        self.names = own_names(host)

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


class _RequestHandler(BaseHTTPRequestHandler):
    """Handles one HTTP request."""

    protocol_version = "HTTP/1.1"
    server_version, sys_version = "automotive-cosim", ""
    timeout = 60
    disable_nagle_algorithm = True
    """A body does not wait until the browser has acknowledged the headers."""

    def do_GET(self) -> None:
        """Answers, or sends the reason for refusing."""
        try:
            path, query, visitor = self._request()
            if query.get("token"):
                self._welcome(path, query["token"])
                return
            self._send(HTTPStatus.OK, self._web.site.answer(path, query, visitor))
        except _RefusedRequestError as refusal:
            is_data = self.path.startswith("/api/")
            why = _json({"error": str(refusal)}) if is_data else WebAnswer(f"{refusal}\n".encode(), "text/plain")
            self._send(refusal.status, why)

    def do_HEAD(self) -> None:
        """The same without a body."""
        self.do_GET()

    def do_POST(self) -> None:
        """Does something in a game; nothing else here can be changed."""
        try:
            path, query, visitor = self._request()
            if self.headers.get("Origin") is None:
                raise _RefusedRequestError(HTTPStatus.FORBIDDEN, "only the pages themselves may do this")
            length = self.headers.get("Content-Length", "")
            if not length.isdecimal() or int(length) > MOST_BYTES:
                raise _RefusedRequestError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"give at most {MOST_BYTES} bytes")
            self._send(HTTPStatus.OK, self._web.site.change(path, query, self.rfile.read(int(length)), visitor))
        except _RefusedRequestError as refusal:
            self.close_connection = True  # the body may not have been read
            self._send(refusal.status, _json({"error": str(refusal)}))

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 (its name in the base class)
        """Silences the base class, which would print every request."""

    @property
    def _web(self) -> WebServer:
        assert isinstance(self.server, WebServer)
        return self.server

    def _request(self) -> tuple[str, dict[str, str], Visitor]:
        """The path, the query and the visitor of a request that may be answered.

        Raises:
            _RefusedRequestError: it comes from elsewhere, or without the token.
        """
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
                return unquote(parts.path), query, visitor
        raise _RefusedRequestError(
            HTTPStatus.FORBIDDEN, "the token is missing or wrong; open the address that the server printed"
        )

    def _cookie(self) -> str:
        try:
            found = SimpleCookie(self.headers.get("Cookie", "")).get(self._cookie_name)
        except CookieError:
            return ""
        return found.value if found else ""

    @property
    def _cookie_name(self) -> str:
        return f"automotive_cosim_{self._web.server_port}"

    def _welcome(self, path: str, token: str) -> None:
        """Swaps the token in the address for a cookie."""
        self.send_response(HTTPStatus.SEE_OTHER)
        self.send_header("Location", path if path.startswith("/") and not path.startswith("//") else "/")
        cookie = f"{self._cookie_name}={token}; HttpOnly; SameSite=Strict; Path=/"
        self.send_header("Set-Cookie", cookie)
        self._end(b"")

    def _send(self, status: HTTPStatus, answer: WebAnswer) -> None:
        body = answer.body
        self.send_response(status)
        self.send_header("Content-Type", answer.kind + ("; charset=utf-8" if "image" not in answer.kind else ""))
        self.send_header("Cache-Control", f"private, max-age={answer.keep_s}" if answer.keep_s else "no-store")
        text = not answer.kind.startswith("image/")
        if text and len(body) > SMALL_BYTES and "gzip" in self.headers.get("Accept-Encoding", ""):
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
