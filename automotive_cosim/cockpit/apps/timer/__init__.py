"""Timer: tells the driver when some minutes are over, such as those of a parking disc or until a break."""
