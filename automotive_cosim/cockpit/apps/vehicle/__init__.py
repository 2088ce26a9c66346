"""Vehicle: lamps and wipers, assistance, doors, seats, mirrors, and the lights inside."""
