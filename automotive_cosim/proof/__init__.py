"""Proves tasks: solvable by public actions, not by trivial strategies, clean, repeatable."""
