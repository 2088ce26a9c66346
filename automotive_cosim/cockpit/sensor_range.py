"""How far the car's sensors, its map and its traffic service reach: declared here and nowhere else."""

from __future__ import annotations

RADAR_M = 150.0
"""Reach of the forward radar; a typical long-range one."""
CAMERA_M = 150.0
"""How far off the forward camera sees hazard lights, in clear air; as far as the radar reaches, our choice."""
REAR_RADAR_M = 80.0
"""Reach of the radars at the rear corners; those for lane change warnings look 70 to 100 m back (ISO 17387 asks for
warnings of vehicles that close at up to 20 m/s)."""
CLOSING_MPS = 3.0
"""Closing speed from which a vehicle behind comes up rather than follows; our choice."""
BLUE_LIGHT_M = 300.0
"""Reach of the radio message of an emergency vehicle (ETSI EN 302 637-2, emergency container) between houses; our
choice of the usual few hundred metres."""
HORIZON_M = 2000.0
"""How far ahead on the route the map tells tunnels, signs, schools and incidents. ADASIS v2 can pass on 8 km; two
are a usual horizon, and a minute of driving on a motorway."""
NEWS_EVERY_S = 60.0
"""How often the traffic service reports: live feeds are renewed once a minute, so news is up to a minute old."""
