"""Whatever lies in a run folder, and however requests come, the other pages are shown and nothing leads out."""

import http.client
import json
import os
import shutil
import socket
import threading
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from urllib.parse import quote

import pytest

from automotive_cosim.formats.bounds import VALUES
from automotive_cosim.formats.writing import is_being_written
from automotive_cosim.serve import server as server_module
from automotive_cosim.serve.dealing import PeoplePlan
from automotive_cosim.serve.play import Game
from automotive_cosim.serve.server import MOST_BYTES, WebServer
from automotive_cosim.serve.study import PeopleStudy
from tests.laws import over

from .conftest import HOSTILE, Browser, write_evaluation, write_record

Serving = Callable[..., Browser]

POSTS = ("/api/play/start", "/api/play/act", "/api/play/pace", "/api/play/leave", "/api/study/join",
         "/api/study/begin", "/api/study/answer", "/api/study/play/act")  # fmt: skip


def shown(browser: Browser) -> list[str]:
    return sorted(record["name"] for record in browser("/api/runs").json["records"])


def test_pipes_in_a_folder_hang_nothing(serving: Serving, tmp_path: Path) -> None:
    write_record(tmp_path / "good")
    for name, files in (
        ("evaluation", ("lock", "manifest.json", "traces/one.jsonl.gz", "pictures/one/screenshots/step_000.jpg")),
        ("second", ("lock", "episodes.jsonl")),
    ):
        folder = write_evaluation(tmp_path / name)
        for each in files:
            (folder / each).unlink(missing_ok=True)
            os.mkfifo(folder / each)
    folder = write_evaluation(tmp_path / "third")
    os.mkfifo(folder / "lock")
    os.mkfifo(folder / "pictures" / "one" / "road.jsonl.gz")
    run = write_record(tmp_path / "run")
    for each in ("road.jsonl.gz", "screenshots/step_000.jpg"):
        (run / each).unlink()
        os.mkfifo(run / each)
    browser = serving(tmp_path)
    assert shown(browser) == ["good", "run", "third"]
    for record in browser("/api/runs").json["records"]:
        for path in ("", "/steps", "/road", "/pictures/0", "/episodes/one", "/episodes/one/steps"):
            assert browser(f"/api/runs/{record['id']}{path}").status in (200, 404, 422)
        assert browser(f"/api/evaluations/{record['id']}").status in (200, 404)


def test_links_in_an_evaluation_do_not_lead_out(serving: Serving, tmp_path: Path) -> None:
    secret = write_evaluation(tmp_path / "secret", agent="a-secret")
    for number, name in enumerate(("manifest.json", "episodes.jsonl", "traces/one.jsonl.gz", "pictures/one")):
        folder = write_evaluation(tmp_path / "shown" / str(number), agent="mine")
        if (folder / name).is_dir():
            shutil.rmtree(folder / name)
        else:
            (folder / name).unlink()
        (folder / name).symlink_to(secret / name)
    browser = serving(tmp_path / "shown")
    assert shown(browser) == ["2", "3"]
    answers = [browser("/api/runs")]
    for record in answers[0].json["records"]:
        answers += [
            browser(f"/api/runs/{record['id']}/episodes/one{path}") for path in ("", "/steps", "/pictures/0")
        ]
        answers.append(browser(f"/api/evaluations/{record['id']}"))
    assert not any(b"a-secret" in answer.body for answer in answers)


def test_json_that_grows_when_it_is_read_is_refused_and_hides_nothing(serving: Serving, tmp_path: Path) -> None:
    write_record(tmp_path / "good", goal=HOSTILE)
    for name, text in (
        ("many", "[" + "[]," * (VALUES // 2 + 1) + "0]"),
        ("deep", "[" * 200_000 + "]" * 200_000),
        ("digits", '{"goal": ' + "9" * 10_000 + "}"),
        ("list", "[1]"),
        ("half", '{"goal": "\\ud800", "manifest": 7}'),
    ):
        (write_record(tmp_path / name) / "trial.json").write_text(text)
    browser = serving(tmp_path)
    assert "good" in shown(browser)
    for record in browser("/api/runs").json["records"]:
        answer = browser(f"/api/runs/{record['id']}")
        assert answer.status == 200 if record["name"] == "good" else answer.status in (200, 422)
        assert answer.headers["Content-Type"].startswith("application/json")


def test_whether_a_pipe_is_written_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "lock")
    assert not is_being_written(tmp_path / "lock")


def test_slow_clients_keep_nobody_waiting(serving: Serving, tmp_path: Path) -> None:
    write_record(tmp_path / "run")
    browser = serving(tmp_path)
    slow = [socket.create_connection(("127.0.0.1", browser.server.server_port)) for _ in range(30)]
    for number, each in enumerate(slow):
        each.sendall(b"POST /api/play/act HTTP/1.1\r\nHost: x\r\nContent-Le"[: 10 + number])
    try:
        assert shown(browser) == ["run"]
        assert browser("/static/app.js").status == 200
    finally:
        for each in slow:
            each.close()


def test_fifty_spectators_are_all_answered(serving: Serving, tmp_path: Path) -> None:
    write_record(tmp_path / "run")
    browser = serving(tmp_path)
    (record,) = browser("/api/runs").json["records"]
    answers: list[int] = []

    def watch() -> None:
        for path in ("/steps", "/pictures/0"):
            answers.append(browser(f"/api/runs/{record['id']}{path}").status)

    watching = [threading.Thread(target=watch) for _ in range(50)]
    for each in watching:
        each.start()
    for each in watching:
        each.join(60)
    assert answers == [200] * 100


@over(POSTS)
def test_no_other_site_posts_even_with_the_cookie(path, serving, tmp_path):
    browser = serving(tmp_path)
    own = f"http://127.0.0.1:{browser.server.server_port}"
    for origin in ("http://evil.example", "null", own.replace("127.0.0.1", "localhost"), f"{own}.evil.example"):
        assert browser(path, "POST", body="{}", Origin=origin).status == 403
    assert browser(path, "POST", body="{}").status == 403  # a form of an old browser
    assert browser(path, "POST", token="wrong", body="{}", Origin=own).status == 403
    assert browser(path, "POST", body="{}", Origin=own).status == 405  # neither playing nor a study


@over([("x" * (MOST_BYTES + 1), 413), ("", 405), ("[" * 5000, 405), ("\x00\xff", 405)])
def test_a_body_of_any_kind_gets_an_answer(body, status, serving, tmp_path):
    browser = serving(tmp_path)
    own = f"http://127.0.0.1:{browser.server.server_port}"
    assert browser("/api/play/act", "POST", body=body, Origin=own).status == status
    assert browser("/api/runs").status == 200


@over(["-1", "1e9", "x", "99999999999", "9" * 5000, "+5", "٣"])
def test_a_length_that_is_none_is_refused(length, serving, tmp_path):
    browser = serving(tmp_path)
    port = browser.server.server_port
    with socket.create_connection(("127.0.0.1", port), timeout=10) as raw:
        head = f"POST /api/play/act HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\n"
        cookie = f"Cookie: automotive_cosim_{port}={browser.server.token}\r\n"
        raw.sendall((head + cookie + f"Content-Length: {length}\r\n\r\n{{}}").encode())
        assert raw.recv(100).split()[1] in (b"413", b"400")
    assert json.loads(browser("/api/runs").body)["records"] == []


def raw(server: WebServer, head: str, *, to_the_end: bool = True) -> bytes:
    """What comes back for the bytes of a head."""
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(head.encode("latin-1"))
        answer = b""
        while chunk := line.recv(65536):
            answer += chunk
            if not to_the_end:
                break
    return answer


@over(
    ["/", "/%0d%0aX-Made:of-a-path", "/\xe9", "//evil.example/", "/%2f%2fevil.example", "/x%00", "/" + "a" * 9000]
)
def test_no_header_is_made_of_a_path(path, serving, tmp_path):
    server = serving(tmp_path).server
    port = server.server_port
    head = f"GET {path}?token={server.token} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n"
    lines = raw(server, head).split(b"\r\n\r\n")[0].decode("latin-1").splitlines()
    assert lines[0].split()[1] == "303"
    assert [line for line in lines if line.lower().startswith("location")] == ["Location: /"]
    assert not [line for line in lines if line.startswith("X-Made")]


@over(
    [
        ("GET http://[ HTTP/1.1", "", 400),
        ("GET /api/runs?skip=%ff&%00=\xff HTTP/1.1", "", 200),
        ("GET /%ff%fe HTTP/1.1", "", 404),
        ("GET /api/tasks/%d9%a3 HTTP/1.1", "", 404),
        ("GET /" + "a" * 40_000 + " HTTP/1.1", "", 414),
        ("GET / HTTP/1.1", "X-Long: " + "a" * 40_000 + "\r\n", 431),
        ("GET / HTTP/1.1", "".join(f"X-{n}: {'a' * 500}\r\n" for n in range(90)), 431),
        ("GET / HTTP/1.1", 'Cookie: a="' + "\\" * 20_000 + "\r\n", 403),
        ("GET / HTTP/1.1", "Cookie: \xff\xfe; =; ;;==\r\n", 403),
        ("BREW / HTTP/1.1", "", 501),
        ("GET / HTTP/9.9", "", 505),
    ]
)
def test_an_odd_request_gets_an_answer(line, headers, status, serving, tmp_path):
    server = serving(tmp_path).server
    port = server.server_port
    own = "" if headers.startswith("Cookie") else f"Cookie: automotive_cosim_{port}={server.token}\r\n"
    head = f"{line}\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n{own}{headers}\r\n"
    began_s = time.process_time()
    assert int(raw(server, head, to_the_end=False).split()[1]) == status
    assert time.process_time() - began_s < 1.0


@over(["1e999", "-1e999", "NaN", "1" + "0" * 400, "true", '"x"', "[]", "null"])
def test_an_odd_number_gets_an_answer(speed, serving, tmp_path):
    browser = serving(tmp_path, game=Game(tmp_path))
    own = f"http://127.0.0.1:{browser.server.server_port}"
    assert browser("/api/play/pace", "POST", body=f'{{"speed": {speed}}}', Origin=own).status == 422


def test_connections_without_a_token_keep_the_owner_out_neither_by_number_nor_by_time(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_module, "MOST_CONNECTIONS", 8)
    browser = serving(tmp_path)
    own = browser.server
    before = threading.active_count()
    idle = [socket.create_connection(("127.0.0.1", own.server_port), timeout=20) for _ in range(40)]
    try:
        assert browser("/api/runs").status == 200
        assert threading.active_count() <= before + 8 + 2
        ended = sum(each.recv(1) == b"" for each in idle[:20])
        assert ended == 20, "the oldest make room"
        monkeypatch.setattr(server_module, "STRANGER_S", 0.0)
        trickling = idle[-1]
        assert trickling.recv(1) == b"", "none stays for long"
    finally:
        for each in idle:
            each.close()


def test_a_connection_of_the_owner_makes_no_room(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_module, "MOST_CONNECTIONS", 2)
    browser = serving(tmp_path)
    port = browser.server.server_port
    own = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    sent = {"Host": f"127.0.0.1:{port}", "Cookie": f"automotive_cosim_{port}={browser.server.token}"}
    for _ in range(3):
        own.request("GET", "/api/runs", headers=sent)
        line, answer = own.sock, own.getresponse()
        assert (answer.status, answer.read(), own.sock) == (200, b'{"records":[]}', line)
        for _ in range(5):
            with socket.create_connection(("127.0.0.1", port), timeout=20) as stranger:
                stranger.sendall(b"GET / HTT")
    own.close()


def test_who_takes_part_is_given_nothing_of_the_owners_game(serving: Serving, tmp_path: Path) -> None:
    """Both can run on one server; a participant is known by a seat, and without one plays nothing."""
    plan = PeoplePlan(("heron",), ("road_speed_80_in_50", "hvac_fan_max"))
    with closing(PeopleStudy(plan, tmp_path / "mine")) as study:
        browser = serving(tmp_path, game=Game(tmp_path / "own"), study=study)
        own = f"http://127.0.0.1:{browser.server.server_port}"
        person = browser.server.people_token
        for path in ("/api/study/play", "/api/study/play/screen", "/api/study/play?seat="):
            assert browser(path, token=person).status == 422
        for path in ("/api/study/play/act", "/api/study/play/leave"):
            refused = browser(path, "POST", token=person, body="{}", Origin=own)
            assert (refused.status, "choose your code name" in refused.json["error"]) == (422, True)


IDS = (
    "../secret/traces/one",
    "..%2f..%2fsecret",
    "/etc/passwd",
    "one/../../secret",
    ".",
    "",
    "\x00",
    HOSTILE,
    "\ud800",
)


@over(IDS)
def test_the_ids_of_a_forged_evaluation_lead_nowhere(forged, serving, tmp_path_factory):
    there = tmp_path_factory.mktemp("forged")
    write_record(there / "secret", goal="a-secret")
    folder = write_evaluation(there / "shown" / "bundle", agent=HOSTILE)
    first, other = (folder / "episodes.jsonl").read_text("utf-8").splitlines()
    row = json.loads(first) | {"id": forged}
    (folder / "episodes.jsonl").write_text(f"{json.dumps(row)}\n{other}\n", "utf-8")
    browser = serving(there / "shown")
    (record,) = browser("/api/runs").json["records"]
    answers = [browser("/api/runs"), browser(f"/api/evaluations/{record['id']}")]
    asked = quote(forged, safe="", errors="surrogatepass")
    answers += [
        browser(f"/api/runs/{record['id']}/episodes/{asked}{path}")
        for path in ("", "/steps", "/road", "/pictures/0")
    ]
    for answer in answers:
        assert answer.status in (200, 404, 422)
        assert b"a-secret" not in answer.body
        assert answer.headers["Content-Type"].startswith("application/json")
    assert all(answer.status != 200 for answer in answers[2:])


def test_a_picture_that_is_a_page_is_not_shown_as_one(serving: Serving, tmp_path: Path) -> None:
    folder = write_evaluation(tmp_path / "forged")
    (folder / "pictures" / "one" / "screenshots" / "step_000.jpg").write_text(f"<html>{HOSTILE}</html>")
    run = write_record(tmp_path / "run")
    (run / "screenshots" / "step_000.jpg").write_text(f"<svg>{HOSTILE}</svg>")
    browser = serving(tmp_path)
    for record in browser("/api/runs").json["records"]:
        of = "/episodes/one" if record["kind"] == "evaluation" else ""
        answer = browser(f"/api/runs/{record['id']}{of}/pictures/0")
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["Content-Type"] in ("image/jpeg", "image/png") or answer.status == 404
