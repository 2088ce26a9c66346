"""How critical a drive was, and how much was driven in which conditions: each measure is defined once, here."""
