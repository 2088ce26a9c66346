"""Traffic simulation: SUMO behind one protocol."""
