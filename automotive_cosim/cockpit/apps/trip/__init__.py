"""Trip: two trip meters."""
