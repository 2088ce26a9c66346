"""Parking: pays for a space from the car."""
