"""Runs episodes by name, alone or in parallel, and records them."""
