"""Functions of memos."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.apps.memo.commands import Record
from automotive_cosim.cockpit.apps.memo.state import Memos
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, named, offered, unknown
from automotive_cosim.cockpit.state import State


@offered
def record_memo(state: State) -> CallMade:
    """Begin to record a spoken memo, or end the one that is being recorded."""
    return Record()


@offered
def delete_memo(state: State, memo: Annotated[str, "The memo, as the screen memo tells it."]) -> CallMade:
    """Delete a memo."""
    memos = state.of(Memos)
    found = named(memo, memos.kept)
    if found is None:
        return unknown("memo", memo, memos.kept)
    at = memos.kept.index(found)
    return Put(replace(memos, kept=(*memos.kept[:at], *memos.kept[at + 1 :])), "")


FUNCTIONS = (record_memo, delete_memo)
