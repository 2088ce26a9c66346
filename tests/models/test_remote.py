"""The client against a server that is slow, cut off, malformed or refuses, over a real connection."""

import base64
import gzip
import io
import json
import logging
import re
import sys
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.agents import FORMATS, ModelAgent, make_agent
from automotive_cosim.agents.native.grid import GuiScreen
from automotive_cosim.agents.native.verbs import Hand, actions
from automotive_cosim.agents.settings import T3A
from automotive_cosim.contracts import Action
from automotive_cosim.errors import ActionError, ModelError, SetupError, UserError, install_hint
from automotive_cosim.models import ChatMessage, make_model
from automotive_cosim.models.apis import Anthropic, Chat, ChatTools, Gemini, OpenAI
from automotive_cosim.models.base import OUT_PER_S
from automotive_cosim.models.refusal import pause_asked_s, reason, told
from automotive_cosim.models.remote import BODY_LIMIT_BYTES, HIDDEN_TOKENS, _Endpoint
from automotive_cosim.replay.make import Touches, provider_body, texts
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.trial import run_trial
from automotive_cosim.traffic.fork import Simulations

KEY = "sk-a-very-secret-key-0123456789"
LONG_KEY = "sk-ant-api03-kT7bQ9xW2mZ4rV6yL8pN0cJ5hG3fD1sA"

Behave = Callable[[BaseHTTPRequestHandler], None]


def completion(text: object, finish: str = "stop", **usage: int) -> bytes:
    counted = {"prompt_tokens": 7, "completion_tokens": 3} | usage
    choice = {"index": 0, "finish_reason": finish, "message": {"role": "assistant", "content": text}}
    whole = {"id": "x", "object": "chat.completion", "created": 0, "model": "m", "choices": [choice]}
    return json.dumps(whole | {"usage": counted}).encode()


def send(handler: BaseHTTPRequestHandler, status: int, body: bytes, **headers: str) -> None:
    handler.send_response(status)
    handler.send_header("Content-Type", "application/json")
    handler.send_header("Content-Length", str(len(body)))
    for name, value in headers.items():
        handler.send_header(name.replace("_", "-"), value)
    handler.end_headers()
    handler.wfile.write(body)


class Server:
    """Answers each request by the next of ``behaviours``, and the last one for ever."""

    def __init__(self) -> None:
        self.behaviours: list[Behave] = [lambda handler: send(handler, 200, completion("hello"))]
        self.asked: list[dict] = []
        self.keys: list[str] = []
        self.headers: list[dict[str, str]] = []
        server = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                server.asked.append({"path": self.path, **json.loads(body)})
                server.keys.append(self.headers["Authorization"])
                server.headers.append({name.lower(): value for name, value in self.headers.items()})
                behave = server.behaviours.pop(0) if len(server.behaviours) > 1 else server.behaviours[0]
                try:
                    behave(self)
                except OSError:  # the client has gone
                    self.close_connection = True

            def log_message(self, *_: object) -> None: ...

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._http.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._http.server_port}/v1"
        threading.Thread(target=self._http.serve_forever, args=(0.01,), daemon=True).start()

    def close(self) -> None:
        self._http.shutdown()
        self._http.server_close()


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    """A server, and the environment that leads ``local/...`` to it."""
    made = Server()
    monkeypatch.setenv("LOCAL_API_KEY", KEY)
    monkeypatch.setenv("LOCAL_BASE_URL", made.url)
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    yield made
    made.close()


ASK = [ChatMessage("user", "hi")]
QUICK = "local/m?timeout_s=0.3&retries=2"


def model(spec: str = "local/m"):
    """The model, which notes its pauses in place of waiting."""
    made = make_model(spec)
    made.pauses = []
    made._sleep = made.pauses.append
    return made


def test_text_tokens_and_cost_come_back(server):
    reply = model("local/m?usd_per_million_in=2&usd_per_million_out=10").chat(ASK)
    assert (reply.text, reply.tokens_in, reply.tokens_out, reply.finish) == ("hello", 7, 3, "stop")
    assert reply.cost_usd == pytest.approx((7 * 2 + 3 * 10) / 1e6)
    assert reply.seconds > 0


def test_what_is_asked_is_what_the_settings_say(server):
    model("local/meta/some-model?seed=4&temperature=0.5&max_tokens=50").chat(ASK)
    asked = server.asked[0]
    assert asked["path"] == "/v1/chat/completions"
    assert (asked["model"], asked["seed"], asked["temperature"], asked["max_tokens"]) == (
        "meta/some-model", 4, 0.5, 50,
    )  # fmt: skip
    assert asked["messages"] == [{"role": "user", "content": "hi"}]
    assert server.keys == [f"Bearer {KEY}"]


def test_none_leaves_a_setting_to_the_provider(server):
    model("local/m?seed=none&temperature=none&max_tokens=none").chat(ASK)
    assert not {"seed", "temperature", "max_tokens"} & set(server.asked[0])


def test_openai_itself_is_asked_in_its_present_words(server, monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    monkeypatch.setenv("OPENAI_BASE_URL", server.url)
    model("openai/m").chat(ASK)
    assert server.asked[0]["max_completion_tokens"] == 1024


def test_pictures_go_along_as_they_are(server):
    model().chat([ChatMessage("user", "look", (b"\x89PNG one", b"\x89PNG two"))])
    parts = server.asked[0]["messages"][0]["content"]
    assert [part["type"] for part in parts] == ["text", "image_url", "image_url"]
    sent = [base64.b64decode(part["image_url"]["url"].split(",")[1]) for part in parts[1:]]
    assert sent == [b"\x89PNG one", b"\x89PNG two"]


def test_sound_goes_along_where_there_is_a_form_for_it_and_elsewhere_one_line_says_so(server):
    spoken = ChatMessage("user", "listen", (b"RIFF one", b"\x89PNG two"))
    model().chat([spoken])
    parts = server.asked[0]["messages"][0]["content"]
    assert [part["type"] for part in parts] == ["text", "input_audio", "image_url"]
    assert parts[1]["input_audio"] == {"data": base64.b64encode(b"RIFF one").decode(), "format": "wav"}
    told = Gemini().body("m", [spoken], {})["contents"][0]["parts"]
    assert [part["inlineData"]["mimeType"] for part in told[1:]] == ["audio/wav", "image/png"]
    for api in (Anthropic(), OpenAI()):
        with pytest.raises(ModelError, match="takes no sound; choose another, or --hear cabin"):
            api.body("m", [spoken], {})


@pytest.mark.parametrize("status", [408, 409, 429, 500, 502, 503])
def test_what_may_pass_is_tried_again_with_longer_pauses(server, status):
    fails = lambda handler: send(handler, status, b'{"error": {"message": "busy"}}')  # noqa: E731
    server.behaviours = [fails, fails, fails, *server.behaviours]
    made = model()
    assert made.chat(ASK).text == "hello"
    assert len(server.asked) == 4
    assert made.pauses == sorted(made.pauses)
    assert len(set(made.pauses)) == 3


RETRY_INFO = {"@type": "type.googleapis.com/google.rpc.RetryInfo", "retryDelay": "34.07s"}
DATED = {"Date": "Wed, 21 Oct 2026 07:28:00 GMT"}
PAUSES = [
    ({"Retry_After": "7"}, "{}", 7.0),
    ({"Retry_After": "1.5"}, "", 1.5),
    ({"Retry_After": "1m30s"}, "", 90.0),
    ({"Retry_After_ms": "2500", "Retry_After": "3"}, "{}", 2.5),
    ({"x_ms_retry_after_ms": "4000"}, "{}", 4.0),
    ({"Retry_After": "Wed, 21 Oct 2026 07:28:12 GMT", **DATED}, "", 12.0),
    ({"Retry_After": "Wednesday, 21-Oct-26 07:28:12 GMT", **DATED}, "", 12.0),
    ({"Retry_After": "Wed Oct 21 07:28:12 2026", **DATED}, "", 12.0),
    ({"Retry_After": "2026-10-21T07:28:12Z", **DATED}, "", 12.0),
    ({"Retry_After": "Wed, 21 Oct 2020 07:28:12 GMT"}, "", 0.5),
    ({"Retry_After": "0"}, "{}", 0.5),
    ({"x_ratelimit_reset_requests": "1m30s"}, "{}", 90.0),
    (
        {
            "x_ratelimit_reset_tokens": "90ms",
            "x_ratelimit_remaining_tokens": "80",
            "x_ratelimit_reset_requests": "12s",
            "x_ratelimit_remaining_requests": "0",
        },
        "{}",
        12.0,
    ),
    ({"anthropic_ratelimit_tokens_reset": "2026-10-21T07:28:12Z", **DATED}, "{}", 12.0),
    ({"RateLimit": '"minute";r=0;t=30'}, "{}", 30.0),
    ({}, {"error": {"metadata": {"headers": {"X-RateLimit-Remaining": "0", "X-RateLimit-Reset": "5"}}}}, 5.0),
    ({"x_ratelimit_reset": "1793518092"}, "{}", 0.5),
    ({"x_ratelimit_reset_requests": "20", "x_ratelimit_remaining_requests": "3"}, "{}", 0.5),
    ({}, {"error": {"code": 429, "details": [RETRY_INFO]}}, 34.07),
    ({}, [{"error": {"code": 429, "message": "Quota exceeded.", "details": [RETRY_INFO]}}], 34.07),
    ({}, {"retryDelay": {"seconds": "7", "nanos": 500_000_000}}, 7.5),
    ({}, {"error": {"message": "busy", "retry_after": 9}}, 9.0),
    ({}, {"retry_after_ms": 900}, 0.9),
    ({}, {"error": {"message": "Rate limit reached. Please try again in 1m2.5s. Visit our page."}}, 62.5),
    ({}, {"error": {"message": "Limit 3 in 20 s. Please try again in 640ms."}}, 0.64),
    ({}, "Too many requests, retry after 26 seconds.", 26.0),
    *(({"Retry_After": odd}, "{}", 0.5) for odd in ("soon", "-3", "nan", "1e400", "")),
    ({}, {"error": {"message": "The limit is 50 requests in 60 s"}}, 0.5),
]


@pytest.mark.parametrize(("headers", "body", "pause_s"), PAUSES)
def test_the_pause_that_the_server_asks_for_is_kept_in_every_form(server, headers, body, pause_s):
    def busy(handler: BaseHTTPRequestHandler) -> None:
        handler.date_time_string = lambda *_: headers.get("Date", "Wed, 21 Oct 2026 07:28:00 GMT")
        own = {name: value for name, value in headers.items() if name != "Date"}
        send(handler, 429, (body if isinstance(body, str) else json.dumps(body)).encode(), **own)

    server.behaviours.insert(0, busy)
    made = model()
    reply = made.chat(ASK)
    assert made.pauses == [pytest.approx(pause_s)]
    assert (reply.seconds == 0) == (pause_s != 0.5)  # a pause that is asked for is none of the model's


def test_a_server_that_says_when_to_come_back_has_not_failed(server):
    wait = lambda handler: send(handler, 503, b"{}", Retry_After="12")  # noqa: E731
    server.behaviours = [*[wait] * 8, *server.behaviours]
    made = model()
    assert made.chat(ASK).text == "hello"
    assert made.pauses == [12.0] * 8
    server.behaviours = [wait]
    with pytest.raises(ModelError, match="612 s"):
        made.chat(ASK)
    server.asked.clear()
    with pytest.raises(ModelError, match="1 attempts"):
        model("local/m?retries=0").chat(ASK)
    assert len(server.asked) == 1


def test_a_pause_until_tomorrow_is_told_at_once(server):
    server.behaviours = [lambda handler: send(handler, 429, b'{"error": "quota"}', Retry_After="86400")]
    made = model()
    with pytest.raises(ModelError, match=r"is busy: status 429: quota; it asks for a pause of 86,400 s"):
        made.chat(ASK)
    assert (made.pauses, len(server.asked)) == ([], 1)


REFUSALS = [
    ({"error": {"message": "no such model", "type": "x"}}, "no such model"),
    ({"error": "'type' must be 'text'"}, "'type' must be 'text'"),
    ({"error": ["a is missing", "b is missing"], "warnings": []}, "a is missing; b is missing"),
    ({"error": {"code": "bad", "param": "p"}}, '{"code": "bad", "param": "p"}'),
    ([{"error": {"code": 400, "message": "call after user", "status": "INVALID"}}], "call after user"),
    ({"detail": "Not allowed"}, "Not allowed"),
    ({"detail": [{"loc": ["body", "seed"], "msg": "extra", "type": "t"}]}, "body.seed: extra"),
    ({"object": "error", "message": {"detail": [{"loc": ["body"], "msg": "extra"}]}}, "body: extra"),
    ({"object": "error", "message": "too long", "code": 400}, "too long"),
    ({"title": "Bad Request", "status": 400, "detail": "no tools"}, "Bad Request; no tools"),
    ({"status": 400, "error": "Bad Request", "message": "no tools", "path": "/v1"}, "Bad Request; no tools"),
    ({"errors": [{"message": "one"}, {"message": "two"}]}, "one; two"),
    ({"error": {"message": "Provider", "metadata": {"raw": '{"error": "the cause"}'}}}, "Provider; the cause"),
    ({"Message": "signature"}, "signature"),
    ('data: {"error": {"message": "in a stream"}}\n\n', "in a stream"),
    ({"fault": {"faultstring": "no key"}}, "no key"),
    ("just\nwords", "just words"),
    ("<html><style>p {x}</style><h1>502 Bad</h1>\n<p>gateway</p></html>", "502 Bad gateway"),
    ('"words"', "words"),
    ("[" * 5_000, "[[["),
]


@pytest.mark.parametrize(("body", "said"), REFUSALS, ids=lambda each: str(each)[:30])
def test_the_reason_of_a_refusal_is_told_in_every_form(server, body, said):
    told = body if isinstance(body, str) else json.dumps(body)
    for status, retries in ((400, 4), (500, 0)):
        server.behaviours = [lambda handler, status=status: send(handler, status, told.encode())]
        with pytest.raises(ModelError, match=rf"status {status}: {re.escape(said)}") as caught:
            model(f"local/m?retries={retries}").chat(ASK)
        assert "\n" not in str(caught.value)
        assert len(str(caught.value)) < 400


@pytest.mark.parametrize("status", [400, 401, 403, 404, 422])
def test_what_will_not_pass_is_not_tried_again(server, status):
    server.behaviours = [lambda handler: send(handler, status, b'{"error": {"message": "no such model"}}')]
    with pytest.raises(ModelError, match=str(status)):
        model().chat(ASK)
    assert len(server.asked) == 1


def test_it_gives_up_after_its_attempts(server):
    server.behaviours = [lambda handler: send(handler, 500, b"{}")]
    with pytest.raises(ModelError, match="3 attempts") as caught:
        model("local/m?retries=2").chat(ASK)
    assert len(server.asked) == 3
    assert "\n" not in str(caught.value)


def _silent(handler) -> None:
    time.sleep(1.0)


def _trickling(handler) -> None:
    """Keeps every single wait short and never comes to an end."""
    handler.send_response(200)
    handler.send_header("Content-Type", "application/json")
    handler.send_header("Content-Length", "1000")
    handler.end_headers()
    for _ in range(40):
        handler.wfile.write(b" ")
        handler.wfile.flush()
        time.sleep(0.05)


def _cut_off(handler) -> None:
    whole = completion("never whole")
    handler.send_response(200)
    handler.send_header("Content-Type", "application/json")
    handler.send_header("Content-Length", str(len(whole)))
    handler.end_headers()
    handler.wfile.write(whole[:40])
    handler.close_connection = True


def _hanging_up(handler) -> None:
    handler.close_connection = True
    handler.connection.close()


@pytest.mark.parametrize("behave", [_silent, _trickling, _cut_off, _hanging_up], ids=lambda f: f.__name__[1:])
def test_slow_and_broken_connections_are_tried_again(server, behave):
    server.behaviours.insert(0, behave)
    assert model(QUICK).chat(ASK).text == "hello"
    assert len(server.asked) == 2


@pytest.mark.parametrize(
    "body",
    [
        b"", b"{", b"null", b"[]", b"<html>busy</html>", b"{}", b'{"choices": null}', b'{"choices": [3]}',
        b'{"error": {"message": "overloaded"}, "choices": []}', b"\xff\xfe", b"[" * 100_000,
    ],
    ids=lambda body: body[-20:].decode(errors="replace") or "empty",
)  # fmt: skip
def test_a_malformed_answer_is_tried_again(server, body):
    server.behaviours.insert(0, lambda handler: send(handler, 200, body))
    assert model(QUICK).chat(ASK).text == "hello"


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (None, ""),
        ("", ""),
        (7, ""),
        ("a\ud800b", "a?b"),
        ([{"type": "text", "text": "a"}, {"type": "text", "text": "b"}], "ab"),
        (["a", {"type": "text", "text": None}, None], "a"),
        ([{"type": "thinking", "thinking": [{"type": "text", "text": "Hm."}]}, {"type": "text", "text": "b"}], "b"),
        ([{"type": "reasoning", "text": "Hm."}, {"type": "redacted_thinking", "data": "x"}], ""),
        ([{"text": "Hm.", "thought": True}, {"text": "b"}], "b"),
    ],
)
def test_an_answer_without_text_is_an_empty_one(server, content, text):
    server.behaviours = [lambda handler: send(handler, 200, completion(content))]
    reply = model().chat(ASK)
    assert reply.text == text
    assert (reply.reasoning == "Hm.") == ("Hm." in str(content))


@pytest.mark.parametrize(
    "body", [b'{"choices": []}', b'{"choices": [{}]}', b'{"choices": [{"message": null, "finish_reason": "stop"}]}']
)
def test_a_model_that_says_nothing_has_answered(server, body):
    server.behaviours = [lambda handler: send(handler, 200, body)]
    assert model("local/m?retries=0").chat(ASK).text == ""


@pytest.mark.parametrize("tokens", [b"-1", b"Infinity", b"NaN", b"1e300", b"9" * 400, b'"many"', b"null", b"true"])
def test_a_number_of_tokens_that_cannot_be_costs_no_answer(server, tokens):
    server.behaviours = [lambda handler: send(handler, 200, completion("hi").replace(b"7", tokens))]
    reply = model("local/m?retries=0&usd_per_million_in=1").chat(ASK)
    assert (reply.text, reply.tokens_in, reply.tokens_out) == ("hi", 0, 3)
    assert reply.cost_usd == 0


@pytest.mark.parametrize(
    ("counted", "tokens_in", "cached"),
    [
        ({"prompt_tokens": 12, "prompt_tokens_details": {"cached_tokens": 2495}}, 2507, 2495),  # litellm 23342
        ({"prompt_tokens": 100, "prompt_tokens_details": {"cached_tokens": 90}}, 100, 90),
        ({"prompt_tokens": 100, "prompt_tokens_details": {"cached_tokens": -5}}, 100, 0),
        ({"prompt_tokens": 100, "prompt_tokens_details": {"cached_tokens": None}}, 100, 0),
        ({"prompt_tokens": 100, "prompt_tokens_details": []}, 100, 0),
        ({"prompt_tokens": None}, 0, 0),
        ({"prompt_tokens": "100"}, 100, 0),
    ],
)
def test_cached_tokens_are_part_of_the_question_however_they_are_counted(server, counted, tokens_in, cached):
    server.behaviours = [lambda handler: send(handler, 200, completion("hi", **counted))]
    reply = model("local/m?retries=0").chat(ASK)
    assert (reply.text, reply.tokens_in, reply.tokens_cached) == ("hi", tokens_in, cached)


def test_calls_that_the_server_took_out_of_the_answer_are_in_its_text(server):
    told = json.loads(completion(None, finish="tool_calls"))
    function = {"name": "mobile_use", "arguments": '{"action": "wait"}'}
    told["choices"][0]["message"]["tool_calls"] = [{"id": "1", "type": "function", "function": function}]
    server.behaviours = [lambda handler: send(handler, 200, json.dumps(told).encode())]
    reply = model("local/m?retries=0").chat(ASK)
    assert json.loads(reply.text.removeprefix("<tool_call>\n").removesuffix("\n</tool_call>")) == {
        "name": "mobile_use",
        "arguments": {"action": "wait"},
    }
    assert reply.ending == ""


@pytest.mark.parametrize(
    ("form", "body", "why"),
    [
        (
            "gemini",
            {"candidates": [{"content": {}, "finishReason": "MALFORMED_FUNCTION_CALL"}]},
            "malformed_function_call",
        ),
        ("gemini", {"candidates": [{"finishReason": "SAFETY"}]}, "safety"),
        ("gemini", {"promptFeedback": {"blockReason": "OTHER"}}, "other"),
        ("gemini", {"candidates": []}, "no candidates"),
        ("gemini", {"usageMetadata": {"promptTokenCount": 9}, "modelVersion": "m"}, "no candidates"),
        ("gemini", {"candidates": [{"content": {"parts": [None, {"functionCall": None}]}}]}, ""),
        ("openai", {"output": []}, ""),
        ("openai", {"output": [], "incomplete_details": {"reason": "content_filter"}}, "content_filter"),
        ("openai", {"output": [{"type": "message", "content": None}]}, ""),
        ("openai", {"output": [{"type": "function_call", "name": "car", "arguments": '{"action_type": '}]}, ""),
        ("openai", {"output": [{"type": "computer_call"}]}, ""),
        ("openai", {"output": [None, {"type": "computer_call", "actions": [None]}]}, ""),
        ("anthropic", {"content": [], "stop_reason": "refusal"}, "refusal"),
        ("anthropic", {"content": [None, {"type": "tool_use", "name": "computer", "input": "{}"}]}, ""),
        ("anthropic", {"content": [{"type": "tool_use", "name": "computer", "input": {}}]}, ""),
        (
            "anthropic",
            {"content": [{"type": "tool_use", "name": "computer"}], "stop_reason": "max_tokens"},
            "longest",
        ),
    ],
)
def test_an_empty_answer_or_a_bad_call_is_the_models_and_is_told(form, body, why):
    api = FORMATS[form].api
    assert api is not None
    reply = api.read(body)
    assert why in reply.ending
    assert bool(why) == bool(reply.ending)
    with pytest.raises(ActionError):
        acts(form, reply.text)


@pytest.mark.parametrize(
    ("form", "body"),
    [
        ("openai", {"status": "failed", "error": {"message": "busy"}, "output": []}),
        ("anthropic", {"type": "error", "error": {"type": "overloaded_error"}}),
        ("gemini", {"error": {"code": 503}}),
        ("", {"choices": [{"finish_reason": "error", "error": {"code": 502}, "message": {"content": "He"}}]}),
    ],
)
def test_an_error_of_the_endpoint_is_not_the_models(form, body):
    with pytest.raises(ValueError, match="the endpoint reports an error"):
        ((form and FORMATS[form].api) or Chat()).read(body)


@pytest.mark.parametrize("calls", [[None], ["wait"], [{"function": None}], [{"function": {"arguments": "{}"}}], {}])
def test_calls_that_are_none_are_no_calls(calls):
    told = {"choices": [{"message": {"content": "so", "tool_calls": calls}}]}
    assert json.loads(ChatTools().read(told).text) == {"say": "so", "calls": []}


def test_calls_without_their_frame_are_read():
    told = {"choices": [{"message": {"content": None, "tool_calls": [{"name": "wait", "arguments": "{}"}]}}]}
    assert json.loads(ChatTools().read(told).text) == {"say": "", "calls": [{"name": "wait", "arguments": {}}]}


def acts(form: str, text: str) -> list[Action]:
    """What an answer in a format asks for."""
    verbs, hand = FORMATS[form].verbs, Hand(GuiScreen(9, 9, FORMATS[form].grid))
    return [action for call in FORMATS[form].syntax.read(text, verbs) for action in actions(verbs, call, hand)]


def test_an_answer_that_ran_into_its_limit_says_so(server):
    server.behaviours = [lambda handler: send(handler, 200, completion("Situ", finish="length"))]
    assert model().chat(ASK).finish == "length"


@pytest.mark.parametrize("status", [200, 307, 400, 429, 503])
def test_an_endless_body_is_not_read(server, status):
    server.behaviours = [lambda handler: send(handler, status, b" " * 5_000_000, Location="/elsewhere")]
    with pytest.raises(ModelError, match="bytes"):
        model("local/m?retries=0").chat(ASK)


@pytest.mark.parametrize("at", ["head", "headers", 200, 307, 400, 429, 503])
def test_the_time_of_an_attempt_holds_wherever_it_trickles(server, at):
    def trickle(handler: BaseHTTPRequestHandler) -> None:
        """Keeps every single wait short and never comes to an end."""
        begun = {"head": "", "headers": "HTTP/1.1 200 OK\r\n"}
        handler.wfile.write(
            begun.get(at, f"HTTP/1.1 {at} X\r\nLocation: /x\r\nContent-Length: 9999\r\n\r\n").encode()
        )
        for _ in range(40):
            handler.wfile.write(b"a" if at != "headers" else b"a: b\r\n")
            handler.wfile.flush()
            time.sleep(0.05)

    server.behaviours = [trickle]
    began_s = time.monotonic()
    with pytest.raises(ModelError, match=r"took over 0\.2 s"):
        model("local/m?timeout_s=0.2&retries=0").chat(ASK)
    assert time.monotonic() - began_s < 1.5


@pytest.mark.parametrize(
    ("form", "body", "expected"),
    [
        (
            "json",
            {
                "choices": [{"message": {"content": "hi", "reasoning_content": "Hm."}}],
                "usage": {
                    "prompt_tokens": 100,
                    "completion_tokens": 30,
                    "prompt_tokens_details": {"cached_tokens": 80},
                    "completion_tokens_details": {"reasoning_tokens": 20},
                },
            },
            (100, 30, 20, 80),
        ),
        (
            "openai",
            {
                "output": [
                    {"type": "reasoning", "summary": [{"type": "summary_text", "text": "Hm."}]},
                    {"type": "message", "content": [{"type": "output_text", "text": "hi"}]},
                ],
                "usage": {
                    "input_tokens": 100,
                    "output_tokens": 30,
                    "input_tokens_details": {"cached_tokens": 80},
                    "output_tokens_details": {"reasoning_tokens": 20},
                },
            },
            (100, 30, 20, 80),
        ),
        (
            "anthropic",
            {
                "content": [{"type": "thinking", "thinking": "Hm."}, {"type": "text", "text": "hi"}],
                "usage": {
                    "input_tokens": 5,
                    "cache_read_input_tokens": 80,
                    "cache_creation_input_tokens": 15,
                    "output_tokens": 30,
                },
            },
            (100, 30, 0, 80),
        ),
        (
            "gemini",
            {
                "candidates": [{"content": {"parts": [{"text": "Hm.", "thought": True}, {"text": "hi"}]}}],
                "usageMetadata": {
                    "promptTokenCount": 100,
                    "candidatesTokenCount": 10,
                    "thoughtsTokenCount": 20,
                    "cachedContentTokenCount": 80,
                },
            },
            (100, 30, 20, 80),
        ),
    ],
)
def test_reasoning_and_cached_tokens_are_told_and_paid(server, form, body, expected):
    server.behaviours = [lambda handler: send(handler, 200, json.dumps(body).encode())]
    prices = "usd_per_million_in=10&usd_per_million_out=20"
    for cached, usd in (("", 1600), ("&usd_per_million_cached=1", 880)):
        reply = make_model(f"local/m?{prices}{cached}", FORMATS[form].api).chat(ASK)
        assert (reply.tokens_in, reply.tokens_out, reply.tokens_reasoning, reply.tokens_cached) == expected
        assert reply.reasoning == "Hm."
        assert "Hm." not in reply.text
        assert reply.cost_usd == pytest.approx(usd / 1e6)


def test_a_key_in_the_reasoning_is_hidden_too(server):
    body = {"choices": [{"message": {"content": "hi", "reasoning": f"the key is {KEY}"}}]}
    server.behaviours = [lambda handler: send(handler, 200, json.dumps(body).encode())]
    assert model().chat(ASK).reasoning == "the key is ***"


def test_the_rate_is_kept(server):
    made = model("local/m?per_minute=30")
    for _ in range(3):
        made.chat(ASK)
    assert len(made.pauses) == 2
    assert made.pauses[0] == pytest.approx(2.0, abs=0.5)


def test_no_server_at_all_is_an_error_that_says_where(server):
    server.close()
    with pytest.raises(ModelError, match=r"local/m\S* gave no answer"):
        model("local/m?retries=1").chat(ASK)


def test_the_key_is_nowhere_to_be_read(server, caplog, capfd):
    caplog.set_level(logging.DEBUG)
    stream = io.StringIO()
    handler = logging.StreamHandler(stream)
    logging.getLogger().addHandler(handler)
    made = model("local/m?retries=1")
    said = [repr(made), repr(vars(made)["_endpoint"]), made.name]
    leak = json.dumps({"error": {"message": f"bad key {KEY}"}}).encode()
    server.behaviours = [lambda handler: send(handler, 200, completion(f"your key is {KEY}"))]
    said.append(made.chat(ASK).text)
    for status in (401, 500):
        server.behaviours = [lambda handler, status=status: send(handler, status, leak)]
        with pytest.raises(ModelError) as caught:
            made.chat(ASK)
        said += [str(caught.value), repr(caught.value.__cause__)]
    logging.getLogger().removeHandler(handler)
    told = capfd.readouterr()
    everything = "\n".join([*said, stream.getvalue(), caplog.text, told.out, told.err])
    assert KEY in server.keys[0]
    assert KEY not in everything
    assert "***" in everything


def test_a_short_word_for_a_local_server_is_left_alone_in_answers(server, monkeypatch):
    monkeypatch.setenv("LOCAL_API_KEY", "local")
    server.behaviours = [lambda handler: send(handler, 200, completion("the local law"))]
    assert model().chat(ASK).text == "the local law"


@pytest.mark.parametrize(
    ("spec", "missing"), [("nowhere/m", "NOWHERE_API_KEY"), ("my-own.host/m", "MY_OWN_HOST_API_KEY")]
)
def test_a_missing_key_is_named(spec, missing):
    with pytest.raises(SetupError, match=missing):
        make_model(spec)


def test_a_missing_address_is_named(monkeypatch):
    monkeypatch.setenv("NOWHERE_API_KEY", "x")
    with pytest.raises(SetupError, match="NOWHERE_BASE_URL"):
        make_model("nowhere/m")


@pytest.mark.parametrize(
    ("query", "said"),
    [
        ("sed=1", "seed"),
        ("seed=x", "whole"),
        ("timeout_s=0", "above"),
        ("retries=-1", "from"),
        ("api_key=x", "setting"),
    ],
)
def test_wrong_settings_are_told(server, query, said):
    with pytest.raises(UserError, match=said):
        make_model(f"local/m?{query}")


def test_without_the_package_it_says_what_to_install(server, monkeypatch):
    monkeypatch.setitem(sys.modules, "httpx2", None)
    with pytest.raises(SetupError, match=re.escape(install_hint("models"))):
        make_model("local/m")


@pytest.mark.sumo
def test_no_key_is_in_the_record_of_an_episode(server, tmp_path):
    """The server gives the key away in every answer; the folder must not."""
    text = f'Situation: {KEY}\nPlan: {KEY}\nAction: {{"action_type": "answer", "text": "{KEY}"}}'
    server.behaviours = [lambda handler: send(handler, 200, completion(text))]
    agent = ModelAgent(T3A, make_model("local/m"))
    setup = EpisodeSetup(task="hvac_fan_max", scenario="grid", model=agent.model, max_steps=3)
    result = run_trial(setup, agent, [Recorder(setup, tmp_path / "out")])
    assert result.steps == 3
    assert result.tokens_in == 7 * len(server.asked)
    files = [path for path in (tmp_path / "out").rglob("*") if path.is_file()]
    assert files
    for path in files:
        assert KEY.encode() not in path.read_bytes()


# --- native formats -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def touches(simulations: Simulations) -> list[Action]:
    """The reference solution of the task below."""
    watcher = Touches()
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="oracle", model="none")
    assert run_trial(setup, make_agent("oracle"), (watcher,), simulations=simulations).success
    return watcher.actions


ASKS = {
    "openai": "/responses",
    "anthropic": "/messages",
    "anthropic-2025-01": "/messages",
    "anthropic-2025-11": "/messages",
    "gemini": "/models/some-model:generateContent",
}


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMATS)
def test_a_model_at_an_endpoint_works_the_car_in_its_own_format(
    server: Server, touches: list[Action], simulations: Simulations, tmp_path: Path, form: str
) -> None:
    chosen, said = FORMATS[form], texts(form, touches)

    def answer(text: str) -> Behave:
        return lambda handler: send(handler, 200, json.dumps(provider_body(form, text)).encode())

    server.behaviours = [answer(text) for text in said]
    name = f"local/some-model?seed=7&format={form}"
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="native", model=name)
    result = run_trial(
        setup, make_agent("native", name), (Recorder(setup, tmp_path / "out"),), simulations=simulations
    )
    assert (result.success, result.model) == (True, name)
    assert (result.tokens_in, result.tokens_out) == (7 * len(said), 3 * len(said))
    for asked, headers in zip(server.asked, server.headers, strict=True):
        assert asked["path"] == "/v1" + ASKS.get(form, "/chat/completions")
        assert len(re.findall("iVBORw0KGgo", json.dumps(asked))) == 1  # one picture, a PNG
        assert ("car" in json.dumps(asked.get("tools", ()))) == (chosen.api is not None)
        own = {"anthropic": "x-api-key", "gemini": "x-goog-api-key"}.get(form.partition("-")[0])
        assert headers.get(own or "authorization") == (KEY if own else f"Bearer {KEY}")
        assert ("authorization" in headers) == (own is None)
    again = make_agent("native", f"replay/{tmp_path / 'out'}?format={form}")
    assert run_trial(setup, again, simulations=simulations).trace_sha256 == result.trace_sha256


# --- what is sent, and to whom -----------------------------------------------------------------------------


@pytest.mark.parametrize("status", [301, 302, 303, 307, 308])
def test_a_question_is_not_sent_on(server, monkeypatch, status):
    other = Server()
    server.behaviours = [lambda handler: send(handler, status, b"", Location=f"{other.url}/chat/completions")]
    with pytest.raises(ModelError, match=rf"refused: status {status}.*it sends to {other.url}") as caught:
        make_model("local/m?retries=2").chat([ChatMessage("user", "where is the car?")])
    other.close()
    assert "\n" not in str(caught.value)
    assert len(server.asked) == 1
    assert other.asked == other.keys == []


@given(before=st.binary(max_size=7), after=st.binary(max_size=7))
def test_no_encoding_of_a_key_gets_into_a_record(before, after):
    clean = _Endpoint("local", None, KEY).clean
    whole = before + KEY.encode() + after
    for encoded in (base64.b64encode(whole), base64.urlsafe_b64encode(whole), whole.hex().encode()):
        left = clean(f"it is {encoded.decode()}, is it not?")
        assert "***" in left
        assert len(left) < len(f"it is , is it not? {encoded.decode()}") - len(KEY)
    for text in (KEY, KEY.encode().hex().upper(), KEY[::-1]):
        assert clean(f"<{text}>") == "<***>"
    assert clean("nothing of it") == "nothing of it"


SPELLINGS = (str, str.upper, " ".join, ". ".join, lambda key: key.replace("-", "_"), lambda key: f"{key[:20]}...")
"""However a model says a key; as long as twenty characters of it stand there, it is hidden."""


@pytest.mark.parametrize("spell", SPELLINGS)
def test_no_spelling_of_a_key_gets_into_a_record(spell):
    clean = _Endpoint("local", None, LONG_KEY).clean
    assert clean(f"It is [{spell(LONG_KEY)}]!") in ("It is [***]!", "It is [***...]!")
    assert clean(f"{spell(LONG_KEY)} {spell(LONG_KEY)}").count("***") == 2
    assert clean(f"{LONG_KEY[:15]} and {LONG_KEY[15:30]}") == f"{LONG_KEY[:15]} and {LONG_KEY[15:30]}"


def test_no_part_of_a_key_is_left_where_a_text_is_cut(server):
    refusal = json.dumps({"error": {"message": "x" * 290 + KEY}}).encode()
    for body, status in ((b"x" * 70 + KEY.encode(), 200), (refusal, 400)):
        server.behaviours = [lambda handler, body=body, status=status: send(handler, status, body)]
        with pytest.raises(ModelError) as caught:
            model("local/m?retries=0").chat(ASK)
        assert KEY[:6] not in str(caught.value)
    server.behaviours = [lambda handler: send(handler, 200, completion("hi", finish=KEY + "\ud800" + "y" * 99))]
    finish = model().chat(ASK).finish
    assert finish.startswith("***?y")
    assert len(finish) == 40


@pytest.mark.parametrize("packed", [gzip.compress, zlib.compress])
def test_a_packed_answer_is_read_up_to_its_length_unpacked(server, packed):
    server.behaviours = [lambda handler: send(handler, 200, packed(completion("hi")), Content_Encoding="gzip")]
    assert model().chat(ASK).text == "hi"
    assert server.headers[-1]["accept-encoding"] == "identity"
    long = packed(b" " * (BODY_LIMIT_BYTES + 1))
    assert len(long) < BODY_LIMIT_BYTES / 100
    server.behaviours = [lambda handler: send(handler, 200, long, Content_Encoding="gzip")]
    with pytest.raises(ModelError, match="the answer has over"):
        model().chat(ASK)


@pytest.mark.parametrize(
    ("body", "encoding", "said"),
    [(b"no archive", "gzip", "is damaged"), (b"anything", "br", "is packed by 'br', and nobody asked for that")],
)
def test_an_answer_packed_as_nobody_asked_is_tried_again(server, body, encoding, said):
    server.behaviours = [lambda handler: send(handler, 200, body, Content_Encoding=encoding)]
    with pytest.raises(ModelError, match=said):
        model().chat(ASK)


def test_no_more_tokens_are_believed_than_can_have_been(server):
    server.behaviours = [
        lambda handler: send(
            handler, 200, completion("hi", prompt_tokens=10**9, completion_tokens=10**9, cached_tokens=10**9)
        )
    ]
    reply = model("local/m?usd_per_million_in=1&usd_per_million_out=1").chat(ASK)
    question = len(json.dumps({name: each for name, each in server.asked[-1].items() if name != "path"}))
    assert question <= reply.tokens_in <= question + HIDDEN_TOKENS
    assert reply.tokens_out <= OUT_PER_S * (1 + reply.seconds)
    assert reply.cost_usd == pytest.approx((reply.tokens_in + reply.tokens_out) / 1e6)


def test_a_refusal_of_very_many_reasons_is_read_in_no_time():
    body = json.dumps({"errors": [f"reason {number}" for number in range(300_000)]}).encode()
    began_s = time.process_time()
    assert reason(told(body)).startswith("reason 0; ")
    assert pause_asked_s({"retry-after": "9" * 10**6, "date": "x" * 10**6}, told(b"<script" * 300_000)) is None
    assert time.process_time() - began_s < 5.0
