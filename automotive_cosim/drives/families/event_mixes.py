"""Kinds of events that go together in a cast."""

from __future__ import annotations

DRIVER = ("over_limit", "leader_close", "belt", "phone", "fatigue")
PARKS = ("left_behind",)
"""Where one can park beside the road."""
CAR = ("door", "tyre")
ROAD = ("blue_light", "breakdown", "roadworks", "jam_tail")
WET = ("wipers", "glass_fog")
"""Where it rains on a cool day."""
COLD = ("slippery", "weather_speed")
"""Where it freezes, and where fog forms."""
DARK = ("lamps", "high_beam", "fog_lamps")
"""Where it is dark for most of the drive."""
