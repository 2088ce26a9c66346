"""Manual: the owner's handbook."""
