"""The shipped scenarios, one folder each: scenario.toml, SUMO's own files, and a README that says what it shows."""
