"""Settings: display and units, sound, connections, language and time, privacy, profiles."""
