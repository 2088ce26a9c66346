"""Climate: both seats, fan and air, glass, and a schedule."""
