"""The data types that flow through the co-simulation, once round the loop.

    SUMO -> DrivingState -> GpsFix -> GeoContext -> vehicle signals -> Element -> Observation -> Action
      ^                                                                                            |
      +----------------------------------------- RoadRequest <-------------------------------------+

Everything here is frozen data without behaviour of its own. Field names carry the units: ``_s`` seconds,
``_m`` metres, ``_mps`` metres per second, ``_mps2`` metres per second squared, ``_deg`` degrees, ``_kmh``
kilometres per hour, ``_c`` degrees Celsius, ``_pct`` per cent. ``None`` means that there is none
(no leader, no limit, no projection), never zero.

driving      the car's state on the road, and what is around and ahead of it
roads        the network as a map draws it
snapshot     the road as a picture shows it, with every vehicle
place        weather, position fix, connection, surroundings
observation  what an agent sees
action       what an agent does
requests     the cockpit's requests to the road, and the answers
plain        factors between units, JSON, numbers in texts, and how progress is told
"""

from __future__ import annotations

from automotive_cosim.lazy import lazily

__getattr__, __dir__ = lazily(__name__, __file__)
