"""Recorded trials in the formats of other tools, and scenarios of other tools here.

recording     a kept trial: the road second by second, and what the agent did
opendrive     its road as OpenDRIVE
openscenario  its traffic, lights, weather and acts as OpenSCENARIO XML
trajectories  its traffic as SUMO's FCD, CSV and Parquet
tree          an XML file as a tree that knows its lines
incoming      OpenSCENARIO XML as a scenario
"""
