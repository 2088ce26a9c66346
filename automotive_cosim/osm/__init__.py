"""OSM extract -> scenario: a map, its country's conventions and traffic that keeps flowing.

    settings    what can be set about an import and a download
    overpass    fetches a map from a server, if asked to
    extract     reads any format (overpass_json: a server's), keeps the roads that cars use
    access      who may drive a road, by its access keys
    oneway      in which directions
    lanes       how many lanes each has, and which are for buses (arrows: where they lead)
    barriers    where cars cannot pass
    turns       which turns they may not make
    signs       who stops or yields at junctions; cameras: whom they watch (facing: whom a thing at the road means)
    limits      the limits and zones that a road's tags state
    towns       town or country by the density of the streets, where the tags do not tell
    assumed     the limit that the law of the place sets, where none is stated (country: the most common one)
    roads       all of it for each road: what netconvert is told, and what its edges keep
    ground      water, green and buildings, for pictures (shores: water that the extract cuts)
    network     netconvert, and its result (links: its connections)
    repair      opens the lanes in which cars would be trapped
    expected    reads the tags a second time, in another way
    agreement   compares the network with the map, and with that second reading
    doubts      what the map does not say clearly, in words
    demand      random traffic
    trips       routes for the ego
    folder      scenario.toml, .sumocfg, README
    report      the figures
    importer    all of it in order, atomically

The network's edges keep the OSM tags that geo and tasks use as parameters. An edge without a ``maxspeed`` parameter
has a limit that was assumed, not posted.
"""
