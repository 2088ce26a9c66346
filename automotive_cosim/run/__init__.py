"""Running episodes: building from names, the loop, the record."""
