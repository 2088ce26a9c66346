"""Memos: spoken notes."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.memo.functions import FUNCTIONS
from automotive_cosim.cockpit.apps.memo.screens import memo, memo_note
from automotive_cosim.cockpit.apps.memo.state import Memos
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

APP = App(
    name="memo",
    title=say("Memos"),
    icon=Icon.MEMO,
    order=14,
    where=Where.STORE,
    about=say("Spoken notes"),
    functions=FUNCTIONS,
    pages={"memo": AppPage(memo), "note": AppPage(memo_note, Room.ONE)},
    aliases={"memos": ""},
    starts=lambda state, rng: (Memos(),),
)
