"""The store: apps that can be installed and removed."""
