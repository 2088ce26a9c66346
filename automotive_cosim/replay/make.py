"""Makes the shipped conversations anew: ``python -m automotive_cosim.replay.make``.

Needed once an agent's prompt or the screens in it have changed. The native formats that have one say the reference
solution, touch by touch; T3A, M3A and ASURADA are answered by the stand-in ``rules``.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from automotive_cosim.agents import FORMATS, PROFILES, make_agent
from automotive_cosim.agents.native.grid import GuiScreen
from automotive_cosim.agents.native.verbs import call_for
from automotive_cosim.contracts import Action, ActionType, Json
from automotive_cosim.contracts.ids import resource_id
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.models import ChatMessage, ModelReply, Rules
from automotive_cosim.models.apis import Anthropic, Chat, Gemini, OpenAI, ProviderApi
from automotive_cosim.models.base import estimated_tokens
from automotive_cosim.models.replay import SUFFIX, shipped, text_digest
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.trial import Shot, TrialObserver, run_trial
from automotive_cosim.traffic.fork import Simulations

SETUP = EpisodeSetup("hvac_fan_max", scenario="grid")
SCREEN_PX = (1280, 720)
THOUGHT = "I see what is wanted."


class Touches(TrialObserver):
    """The acts of an agent as touches of the screen, as a model that sees the picture alone would do them."""

    def __init__(self) -> None:
        self.actions: list[Action] = []

    def stepped(self, shot: Shot) -> None:
        """Notes an act; an app is opened in the dock."""
        action = shot.step.action
        assert action is not None
        index = action.index
        if action.action_type is ActionType.OPEN_APP:
            index = [element.resource_id for element in shot.seen].index(resource_id(f"dock.{action.app_name}"))
            action = Action(ActionType.CLICK)
        if index is not None:
            box = shot.seen[index].bbox_pixels
            action = replace(action, index=None, x=(box.x_min + box.x_max) // 2, y=(box.y_min + box.y_max) // 2)
        self.actions.append(action)


class _Tells:
    """A model that sends these bodies, in a conversation that is recorded."""

    name, sees_pictures = "tells", True

    def __init__(self, bodies: Iterator[Json] | None, api: ProviderApi) -> None:
        self._bodies, self._api = bodies, api
        self.answers: list[Json] = []

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        """The next body's answer, to whatever is asked."""
        body = _said_by_rules(messages) if self._bodies is None else next(self._bodies)
        self.answers.append({"asked": text_digest(messages), "body": body})
        return self._api.read(body)


def made(simulations: Simulations) -> dict[str, Json]:
    """Every conversation, by name."""
    watcher = Touches()
    setup = replace(SETUP, agent="oracle", model="none")
    run_trial(setup, make_agent("oracle"), (watcher,), simulations=simulations)
    found = {}
    for name, form in ((name, form) for name, form in FORMATS.items() if name in shipped()):
        bodies = (provider_body(name, text) for text in texts(name, watcher.actions))
        found[name] = _recorded("native", f"replay/{name}?format={name}", bodies, form.api or Chat(), simulations)
    for name in PROFILES:
        found[name] = _recorded(name, f"replay/{name}", None, Chat(), simulations)
    return found


def texts(form: str, actions: Sequence[Action]) -> list[str]:
    """Answers in a native format, one for each action.

    Raises ValueError: the format has no word for one of them."""
    chosen = FORMATS[form]
    screen = GuiScreen(*SCREEN_PX, chosen.grid)
    said = []
    for action in actions:
        call = call_for(chosen.verbs, action, screen)
        if call is None:
            raise ValueError(f"{form} has no word for {action}")
        said.append(chosen.syntax.write(THOUGHT, [call], chosen.verbs))
    return said


def provider_body(form: str, text: str) -> Json:
    """An answer as the provider of a format sends it.

    Args:
        text: the answer as the agent reads it."""
    api = FORMATS[form].api
    if api is None:
        return completion(text, 7, 3)
    told = json.loads(text)
    say, calls = told["say"], [(call["name"], call["arguments"]) for call in told["calls"]]
    usage = {"input_tokens": 7, "output_tokens": 3}
    match api:
        case OpenAI():
            acts = [{"type": "computer_call", "actions": [{"type": name, **given}]} for name, given in calls]
            message = {"type": "message", "content": [{"type": "output_text", "text": say}]}
            return {"output": [{"type": "reasoning"}, message, *acts], "usage": usage}
        case Anthropic(beta=beta):
            uses = [
                {"type": "tool_use", "name": "computer", "input": {"action": name, **given}}
                if beta
                else {"type": "tool_use", "toolset_name": "computer", "name": name, "input": given}
                for name, given in calls
            ]
            return {"content": [{"type": "text", "text": say}, *uses], "usage": usage}
        case Gemini():
            parts = [{"text": say}, *({"functionCall": {"name": name, "args": given}} for name, given in calls)]
            counted = {"promptTokenCount": 7, "candidatesTokenCount": 3}
            return {"candidates": [{"content": {"parts": parts}}], "usageMetadata": counted}
    raise ValueError(f"no body is known for {form}")


def completion(text: str, tokens_in: int, tokens_out: int) -> Json:
    """A chat completion."""
    choice = {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": text}}
    return {"choices": [choice], "usage": {"prompt_tokens": tokens_in, "completion_tokens": tokens_out}}


def _said_by_rules(messages: Sequence[ChatMessage]) -> Json:
    text = Rules().chat(messages).text
    return completion(text, estimated_tokens(*(message.text for message in messages)), estimated_tokens(text))


def _recorded(
    agent: str, model: str, bodies: Iterator[Json] | None, api: ProviderApi, simulations: Simulations
) -> Json:
    tells = _Tells(bodies, api)
    played = make_agent(agent, model, chat_model=tells)
    row = run_trial(replace(SETUP, agent=agent, model=model), played, simulations=simulations)
    shown = {name: getattr(SETUP, name) for name in ("task", "half", "scenario", "seed")}
    return {
        "episode": shown,
        "agent": agent,
        "end": str(row.end),
        "success": row.outcome,
        "sees_pictures": tells.sees_pictures,
        "answers": tells.answers,
    }


def written(conversation: Mapping[str, object]) -> str:
    """A conversation as its file should be."""
    return json.dumps(conversation, indent=1, ensure_ascii=False) + "\n"


def main() -> None:
    """Writes every shipped conversation."""
    with closing(Simulations()) as simulations:
        for name, conversation in made(simulations).items():
            path = Path(__file__).with_name(f"{name}{SUFFIX}")
            write_whole(path, written(conversation))
            print(path)


if __name__ == "__main__":
    main()
