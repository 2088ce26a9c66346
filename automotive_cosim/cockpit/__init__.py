"""The car inside: signals, physics, widgets, screens, picture and accessibility tree."""
