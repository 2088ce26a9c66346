"""The launcher: every app, to be opened."""
