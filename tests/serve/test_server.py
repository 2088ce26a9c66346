"""Who gets an answer from the server, and that it never reads outside its folders."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from automotive_cosim.cli.serve import serve
from automotive_cosim.errors import UserError
from automotive_cosim.serve.server import SECURITY

from .conftest import Browser, write_evaluation, write_record

Serving = Callable[..., Browser]

PATHS = ("/", "/static/app.js", "/api/runs", "/api/tasks", "/api/scenarios", "/api/runs/0123456789ab", "/nowhere")


def ids(browser: Browser) -> list[str]:
    return [record["id"] for record in browser("/api/runs").json["records"]]


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("token", ["", "wrong", "ü"])
def test_nothing_without_the_token(serving: Serving, tmp_path: Path, path: str, token: str) -> None:
    browser = serving(tmp_path)
    refused = browser(path, token=token.encode().decode("latin-1"))
    assert refused.status == 403
    assert b"token" in refused.body
    assert browser(f"{path}?token={'x' * 32}", token="").status == 403


def test_the_token_in_the_address_becomes_a_cookie(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path)
    welcome = browser(browser.server.address.partition(str(browser.server.server_port))[2], token="")
    assert welcome.status == 303
    assert welcome.headers["Location"] == "/"
    cookie = welcome.headers["Set-Cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    token = cookie.partition("=")[2].partition(";")[0]
    assert browser("/", token=token).status == 200
    elsewhere = browser(f"//evil.example/?token={token}", token="")
    assert elsewhere.headers["Location"].startswith("/")
    assert not elsewhere.headers["Location"].startswith("//")


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "", "[::1]"])
def test_another_name_is_refused(serving: Serving, tmp_path: Path, host: str) -> None:
    browser = serving(tmp_path)
    assert browser("/", Host=host.format(port=browser.server.server_port)).status == 400


def test_its_own_names_are_known(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path)
    for name in ("127.0.0.1", "localhost", "LOCALHOST", "[::1]"):
        assert browser("/", Host=f"{name}:{browser.server.server_port}").status == 200


def test_another_site_is_refused(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path)
    port = browser.server.server_port
    assert browser("/api/runs", Origin=f"http://127.0.0.1:{port}").status == 200
    for origin in ("http://evil.example", "null", "http://127.0.0.1", f"https://127.0.0.1:{port}"):
        assert browser("/api/runs", Origin=origin).status == 403


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
def test_it_only_reads(serving: Serving, tmp_path: Path, method: str) -> None:
    refused = serving(tmp_path)("/api/runs", method)
    assert refused.status in (403, 405, 501)


def test_every_answer_forbids_foreign_content(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path)
    for path in PATHS:
        for token in (None, "wrong"):
            answer = browser(path, token=token)
            for name, value in SECURITY.items():
                assert answer.headers[name] == value
    assert browser("/static/app.js", "HEAD").body == b""


@pytest.mark.parametrize(
    "path",
    [
        "/static/../server.py",
        "/static/%2e%2e/server.py",
        "/static/..%2fserver.py",
        "/../../etc/passwd",
        "/api/runs/{id}/pictures/../steps.jsonl",
        "/api/runs/{id}/episodes/../steps",
        "/api/runs/{id}/episodes/..%2f..%2fsecret/steps",
        "/api/runs/{id}/episodes/../../secret/road",
        "/api/runs/{id}/episodes/secret%00/road",
        "/api/scenarios/../grid/map",
        "/api/scenarios/%2e%2e/map",
        "/api/tasks/../runs",
        "/api/runs/{id}/road?skip=-1",
        "/api/runs/{id}/road?skip=1e9",
    ],
)
def test_no_path_leads_out(serving: Serving, tmp_path: Path, path: str) -> None:
    write_record(tmp_path / "shown" / "run")
    write_record(tmp_path / "secret", goal="a secret")
    browser = serving(tmp_path / "shown")
    (run,) = ids(browser)
    answer = browser(path.format(id=run))
    assert answer.status == 404
    assert b"secret" not in answer.body.replace(path.encode(), b"").replace(b"secret\x00", b"")


def test_links_in_a_record_do_not_lead_out(serving: Serving, tmp_path: Path) -> None:
    secret = write_record(tmp_path / "secret", goal="a secret")
    run = write_record(tmp_path / "shown" / "run")
    for name in ("trial.json", "steps.jsonl", "road.jsonl.gz", "screenshots/step_000.jpg"):
        (run / name).unlink()
        (run / name).symlink_to(secret / name)
    (tmp_path / "shown" / "other").symlink_to(secret)
    browser = serving(tmp_path / "shown")
    (found,) = ids(browser)
    for path in ("", "/steps", "/road", "/pictures/0"):
        answer = browser(f"/api/runs/{found}{path}")
        assert b"a secret" not in answer.body
        assert answer.status == 404 or path in ("", "/road")
    assert b"a secret" not in browser("/api/runs").body


def test_listening_everywhere_knows_addresses_but_no_foreign_names(serving: Serving, tmp_path: Path) -> None:
    browser = serving(tmp_path, host="0.0.0.0")
    port = browser.server.server_port
    assert browser("/", Host=f"192.0.2.7:{port}").status == 200
    assert browser("/", Host=f"evil.example:{port}").status == 400
    assert browser("/", Host=f"192.0.2.7:{port}", token="wrong").status == 403


def test_a_search_is_told_from_an_evaluation_and_its_page_runs_nothing(serving: Serving, tmp_path: Path) -> None:
    write_evaluation(tmp_path / "all/mine")
    page = "<h1>found</h1><script>alert(1)</script>"
    (write_evaluation(tmp_path / "all/hunt") / "search.html").write_text(page, encoding="utf-8")
    browser = serving(tmp_path / "all")
    records = {record["name"]: record for record in browser("/api/runs").json["records"]}
    assert {name: record["is_search"] for name, record in records.items()} == {"mine": False, "hunt": True}
    shown = browser(f"/api/evaluations/{records['hunt']['id']}/search.html")
    assert (shown.status, shown.body.decode()) == (200, page)
    assert shown.headers["Content-Type"].startswith("text/html")
    policy = shown.headers["Content-Security-Policy"]
    assert "sandbox" in policy
    assert "default-src 'none'" in policy
    assert "script" not in policy
    assert browser(f"/api/evaluations/{records['hunt']['id']}").json["is_search"]
    assert browser(f"/api/evaluations/{records['mine']['id']}/search.html").status == 404
    (tmp_path / "secret.html").write_text("secret", encoding="utf-8")
    (tmp_path / "all/mine/search.html").symlink_to(tmp_path / "secret.html")
    assert browser(f"/api/evaluations/{records['mine']['id']}/search.html").status == 404


def test_an_evaluation_and_its_episodes(serving: Serving, tmp_path: Path) -> None:
    browser = serving(write_evaluation(tmp_path / "mine"))
    rows = tmp_path / "mine/episodes.jsonl"
    rows.write_text(2 * rows.read_text("utf-8") + '{"id": "cut", ', "utf-8")  # run again, and killed
    (record,) = browser("/api/runs").json["records"]
    assert (record["kind"], record["done"], record["planned"]) == ("evaluation", 2, 2)
    results = browser(f"/api/evaluations/{record['id']}").json
    assert [(row["id"], row["missing"], row["has_trace"]) for row in results["rows"]] == [
        ("one", [], True),
        ("two", ["goal"], False),
    ]
    base = f"/api/runs/{record['id']}/episodes"
    assert browser(f"{base}/one").json["goal"] == "Watch my speed."
    steps = browser(f"{base}/one/steps").json["steps"]
    assert [each["has_picture"] for each in steps] == [True, False, False, False]
    assert [each["has_view"] for each in steps] == [False, True, False, False]
    assert browser(f"{base}/one/views/1").headers["Content-Type"] == "image/jpeg"
    assert browser(f"{base}/one/views/0").status == browser(f"{base}/one/views/x").status == 404
    assert steps[1]["words"] == "taps “Warn driver”"
    assert steps[1]["target"] == [640, 360, 960, 480]
    assert browser(f"{base}/one/pictures/0").headers["Content-Type"] == "image/jpeg"
    alone = browser(f"{base}/one/road").json["lines"]
    assert alone[0]["alone"] is True
    assert [line["seen"][0][1] for line in alone[3:]] == [20.0 * s for s in range(-2, 8)]
    assert browser(f"{base}/two/steps").status == 404


def test_a_damaged_record_is_named_and_hides_no_other(serving: Serving, tmp_path: Path) -> None:
    for name, content in (("a", "{"), ("b", "[]"), ("c", '{"manifest": 3}'), ("d", "[" * 100_000)):
        write_record(tmp_path / name)
        (tmp_path / name / "trial.json").write_text(content, encoding="utf-8")
    write_record(tmp_path / "whole")
    write_record(tmp_path / "killed", finished=False)
    browser = serving(tmp_path)
    records = {record["name"]: record for record in browser("/api/runs").json["records"]}
    assert {name for name, record in records.items() if record["kind"] == "unreadable"} == {"a", "b", "c", "d"}
    assert records["killed"]["end"] == "stopped before the end"
    assert records["killed"]["running"] is False
    for name in "abcd":
        answer = browser(f"/api/runs/{records[name]['id']}")
        assert answer.status == 422
        assert "cannot be read" in answer.json["error"]
    assert len(browser(f"/api/runs/{records['killed']['id']}/steps").json["steps"]) == 4


def test_a_step_without_an_action_is_shown(serving: Serving, tmp_path: Path) -> None:
    """An answer that could not be read is a step without an action."""
    run = write_record(tmp_path / "run")
    lines = [json.loads(line) for line in (run / "steps.jsonl").read_text(encoding="utf-8").splitlines()]
    lines[2]["action"] = None
    for line in lines:
        del line["words"]  # as in a trace
    (run / "steps.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), encoding="utf-8")
    browser = serving(tmp_path)
    shown = browser(f"/api/runs/{ids(browser)[0]}/steps").json["steps"][2]
    assert shown["words"] == "gives no action"
    assert shown["target"] is None


def test_the_command_refuses_in_one_line(tmp_path: Path, serving: Serving) -> None:
    taken = serving(tmp_path).server.server_port
    record = write_record(tmp_path / "run")
    for folders, port, play, why in (
        ([tmp_path / "nowhere"], 0, False, "is not a folder"),
        ([tmp_path], taken, False, "cannot listen"),
        ([record], 0, True, "give a folder of records"),
    ):
        with pytest.raises(UserError, match=why):
            serve(folders, http=("127.0.0.1", port), play=play)
    with pytest.raises(UserError, match="cannot listen"):
        serve([tmp_path], http=("no.such.host.invalid", 0))
