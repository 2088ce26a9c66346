"""The road side: SUMO behind one protocol."""
