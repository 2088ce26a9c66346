"""The command of memos."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.memo.state import Memos
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Record(Command):
    """Begin or end a spoken memo."""

    def aims(self, state: State) -> frozenset[str]:
        """The memos, and that one is being recorded."""
        return frozenset({"apps.memos", "apps.recording"})

    def perform(self, state: State) -> Feedback:
        """The begin, or the memo."""
        memos = state.of(Memos)
        if memos.recording_since_s is None:
            state.keep(replace(memos, recording_since_s=state.time_s))
            return Feedback(FeedbackCode.OK, say("the memo is being recorded"))
        seconds = int(state.time_s - memos.recording_since_s)
        memo = say(
            "Memo {number}, {time}, {length}",
            number=len(memos.kept) + 1,
            time=state.clock,
            length=f"{seconds // 60}:{seconds % 60:02d}",
        )
        state.keep(Memos((*memos.kept, memo)))
        return Feedback(FeedbackCode.OK, say("{memo} is kept", memo=memo))
