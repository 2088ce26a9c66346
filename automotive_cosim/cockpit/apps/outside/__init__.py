"""Outside: rain, fog, ice, glare, dust and air as sensed by the car, and remedies for each."""
