"""What can be seen through the windshield, or behind the car in reverse, drawn from the traffic simulation.

scene    what is in sight, as plain data: roads, signs, signals, vehicles, people, sky
lens     the camera: from metres on the road to pixels, and back
signs    faces of signs, and the heads of signals
bodies   vehicles, people and barriers as a few plane faces
paint    the picture
"""
