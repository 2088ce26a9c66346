"""Phone: calls, contacts and messages."""
