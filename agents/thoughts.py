"""What a model thinks before it answers, which its server may leave in the answer. Thoughts are nobody's actions.

Forms in use: tags (``<think>``, ``<thinking>``, ``<seed:think>``, ``[THINK]``, ``<|START_THINKING|>``, Apertus's
``<|inner_prefix|>``, Open WebUI's ``<details type="reasoning">``, ...),
channels (gpt-oss, Gemma), and sentences (Granite, Apriel). The first mark may stand in the prompt, the last be cut
off.
"""

from __future__ import annotations

import re

from automotive_cosim.errors import ActionError

LOST = "the answer ended within its thoughts, of which nothing is carried out"
_ABOUT = r"(?:\w+[:_]|ant)?(?:think|thought|reason|reflect|ponder|cot\b|scratchpad|monologue|analysis)\w*"
_BEGIN = (
    rf"<\|?(?:(?:begin|start)_(?:of_)?)?{_ABOUT}(?:\s[^<>]*)?\|?>|\[THINK\]|\u25c1think\u25b7|<unused94>(?:thought)?"
    rf"|<\|inner_prefix\|>|&lt;{_ABOUT}&gt;"
    r"|\A\s*(?:here is my thought process:|here are my reasoning steps:)"
)
_END = (
    rf"</\s*{_ABOUT}\s*>|<\|?(?:/|end_(?:of_)?){_ABOUT}\|?>|\[/THINK\]|\u25c1/think\u25b7|<unused95>"
    rf"|<\|inner_suffix\|>|&lt;/{_ABOUT}&gt;"
    r"|^here is my response:|\[BEGIN FINAL RESPONSE\]"
)
_MARK = re.compile(rf"(?P<end>{_END})|(?:{_BEGIN})", re.IGNORECASE | re.MULTILINE)
_FOLDED = re.compile(r"<details\s[^<>]*\breasoning\b[^<>]*>(.*?)(</details>|\Z)", re.DOTALL)
_CHANNEL = re.compile(
    r"<\|channel\|?>\s*(?:analysis|thought)\b(?:\s*<\|message\|>)?"  # gpt-oss; Gemma
    r"(?P<thought>.*?)(?P<end><\|end\|>|<channel\|>|(?=<\|start\|>|<\|channel\|?>|<\|call\|>|<\|return\|>)|\Z)"
    r"|\Aanalysis(?=[^\s\w]|[A-Z])(?P<bare>.*?)(?:(?P<said>assistant(?:final|commentary))|\Z)",  # its tokens eaten
    re.DOTALL,
)
_TOKEN = re.compile(r"_never_used_[0-9a-f]{32}\b")
"""How ByteDance's Seed and UI-TARS 2 end their tags."""
_CONTROL = re.compile(r"<\|\w+\|>(?:assistant|final)?")
"""What stands between the channels of gpt-oss."""


def spoken(text: str) -> str:
    """An answer without its thoughts. Raises ActionError: it ends within them, or says nothing besides."""
    cut, text = False, _TOKEN.sub("", text)

    def channel(found: re.Match[str]) -> str:
        nonlocal cut
        is_open = found.end() == len(text) and not found["end"] and not found["said"]
        cut = cut or (is_open and bool((found["thought"] or found["bare"] or "").strip()))
        return ""

    tagged = _FOLDED.sub(lambda found: f"<think>{found[1]}{'</think>' if found[2] else ''}", text)
    left = _CHANNEL.sub(channel, tagged)
    kept, at, is_within = [""], 0, False
    for mark in _MARK.finditer(left):
        if mark["end"] is None and not is_within:
            kept.append(left[at : mark.start()])
        elif mark["end"] is not None and not is_within:
            kept = [""]  # its beginning stands in the prompt
        is_within, at = mark["end"] is None, mark.end()
    if cut or (is_within and left[at:].strip()):
        raise ActionError(LOST)
    said = "".join(kept) + ("" if is_within else left[at:])
    if said != text and not _CONTROL.sub("", said).strip():
        raise ActionError(LOST)
    return said
