"""The proof that tasks are what they claim: solvable, not free, clean, repeatable."""
