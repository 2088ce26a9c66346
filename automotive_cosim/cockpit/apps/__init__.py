"""The apps of the cockpit, a folder each."""
