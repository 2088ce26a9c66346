"""Calendar: the day's appointments."""
