"""OSM extract -> scenario: a map, its country's conventions and traffic that keeps flowing.

    overpass    fetches a map from a server, if asked to
    extract     reads any format, keeps the roads that cars use
    country     its side of the road and general limits
    limits      what mappers write about speed; what the country says where they write nothing
    network     netconvert, and what came of it
    demand      random traffic
    trips       ways for the ego
    folder      scenario.toml, .sumocfg, README
    report      the figures
    importer    all of it in order, atomically

An imported scenario -> one with a day of traffic:

    counts      what one road carries in each hour
    fit         trips, simulated until the road carries that
    day         the folder and its figures, atomically

The network's edges keep the OSM tags that geo and tasks ask for as parameters. An edge without ``maxspeed`` among
them has a limit that was assumed, not posted.
"""

from automotive_cosim.osm.area import Area
from automotive_cosim.osm.importer import ImportOptions, import_map
from automotive_cosim.osm.report import ImportReport

__all__ = ["Area", "ImportOptions", "ImportReport", "import_map"]
