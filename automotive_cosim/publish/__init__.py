"""Publishing evaluations: one file to publish, its check, and a leaderboard of many."""
