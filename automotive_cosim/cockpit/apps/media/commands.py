"""Commands of media: what plays."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.cockpit.apps.media.state import Library, Listening, skipped, source_of, start
from automotive_cosim.cockpit.commands import set_all
from automotive_cosim.cockpit.signals import MEDIA
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Play(Command):
    """Play an entry, of a playlist or of all there is."""

    uri: str
    playlist: str = ""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({MEDIA.SELECTED.path, "media.playlist"})

    def perform(self, state: State) -> Feedback:
        """Plays it from its beginning, with its source, at the present volume."""
        entry = state.of(Library).by_uri[self.uri]
        values = ((MEDIA.SOURCE, source_of(self.uri)), (MEDIA.SELECTED, self.uri), (MEDIA.ACTION, "PLAY"))
        feedback = set_all(state, values, "")
        if feedback.code is FeedbackCode.REFUSED:
            return feedback
        start(state, entry, self.playlist)
        return Feedback(FeedbackCode.OK, say("{title} plays", title=entry.title))


@dataclass(frozen=True, slots=True)
class Skip(Command):
    """Play another entry of the queue."""

    by: int

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({MEDIA.SELECTED.path, "media.playlist"})

    def perform(self, state: State) -> Feedback:
        """Plays the entry that many places later."""
        return Play(skipped(state, self.by), state.of(Listening).playlist).perform(state)
