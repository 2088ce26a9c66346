"""Media: what plays, the controls, and tracks, playlists, stations, podcasts."""
