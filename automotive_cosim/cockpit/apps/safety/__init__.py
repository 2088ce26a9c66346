"""Safety centre: warn the driver, ask to slow down or stop, call for help."""
