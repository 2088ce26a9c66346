"""OSM extract -> scenario: a map, its country's conventions and traffic that keeps flowing.

    overpass    fetches a map from a server, if asked to
    extract     reads any format, keeps the roads that cars use
    country     its side of the road and general limits
    limits      the mapped speed limits; the country's where none is mapped
    network     netconvert, and its result
    demand      random traffic
    trips       routes for the ego
    folder      scenario.toml, .sumocfg, README
    report      the figures
    importer    all of it in order, atomically

An imported scenario -> one with a day of traffic:

    counts      the hourly counts of one road
    fit         trips, simulated until the road matches its counts
    day         the folder and its figures, atomically

The network's edges keep the OSM tags that geo and tasks use as parameters. An edge without a ``maxspeed`` parameter
has a limit that was assumed, not posted.
"""

from automotive_cosim.osm.area import Area
from automotive_cosim.osm.importer import ImportOptions, import_map
from automotive_cosim.osm.report import ImportReport

__all__ = ["Area", "ImportOptions", "ImportReport", "import_map"]
