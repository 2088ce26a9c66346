"""The apps of the cockpit: a file each, the large ones a folder."""
