"""What an agent is told after each step."""

from __future__ import annotations

import base64
from dataclasses import dataclass

from automotive_cosim.agents.marks import listed, png, road
from automotive_cosim.agents.prompt import listing
from automotive_cosim.cockpit.restrictions import in_words
from automotive_cosim.contracts import Json, Observation
from automotive_cosim.episode.specification import End
from automotive_cosim.interface.trace import plain


@dataclass(frozen=True, slots=True)
class EpisodeTurn:
    """An episode as its agent sees it. Nothing in it comes from the task's checks."""

    episode_id: str
    step: int
    """Actions so far, unreadable ones included."""
    observation: Observation
    end: End | None
    """Why the episode is over; None while it is not."""

    @property
    def picture(self) -> bytes | None:
        """The screen as a PNG file; None for an agent that is not given it."""
        screenshot = self.observation.screenshot
        return None if screenshot is None else png(screenshot)

    @property
    def pictures(self) -> tuple[bytes, ...]:
        """The screen and the view through the windshield, as far as the agent is given them."""
        return (*([] if self.picture is None else [self.picture]), *road(self.observation))

    def as_json(self) -> Json:
        """The turn as a JSON object, without the picture.

        A channel that the agent is not given has no key, nor has a reading that the car does not give. ``elements``
        are those that are visible, each with its index. ``on_watch`` is there on drives alone, and the house rules
        come with the first turn."""
        seen = self.observation
        told: Json = {
            "episode_id": self.episode_id,
            "step": self.step,
            "end": None if self.end is None else str(self.end),
            "goal": seen.goal,
            "said": list(seen.said),
            "time_s": seen.time_s,
            "feedback": {"code": str(seen.feedback.code), "text": seen.feedback.text},
        }
        if seen.on_watch:
            told["on_watch"] = True
        if seen.sounds:
            told["sounds"] = [base64.b64encode(each).decode() for each in seen.sounds]
        if seen.elements is not None:
            told["elements"] = [listing(index, element) for index, element in listed(seen.elements)]
        for name in ("vehicle", "connectivity", "gps"):
            readings = getattr(seen, name)
            if readings is not None:
                told[name] = {key: value for key, value in plain(readings).items() if value is not None}
        if seen.vehicle is not None:
            told["vehicle"]["restrictions"] = in_words(seen.vehicle.restrictions)
        if seen.context is not None:
            told["context"] = seen.context
        if seen.policy is not None and self.step == 0:
            told["policy"] = seen.policy
        return told
