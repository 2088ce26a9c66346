"""The inside of the car: signals, physics, widgets, screens, screenshots and the accessibility tree."""
