"""Map: the road around the car, the route ahead, and destinations."""
