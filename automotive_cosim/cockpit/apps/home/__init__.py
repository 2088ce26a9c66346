"""Home: the map, the drive, and every app at a glance."""
