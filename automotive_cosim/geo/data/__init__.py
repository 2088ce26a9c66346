"""Rules, places and climate as TOML and CSV, each with its law, date and status."""
