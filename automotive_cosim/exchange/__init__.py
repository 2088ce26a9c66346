"""Recorded trials in the formats of other tools, scenarios of other tools here, and demonstrations for learners.

recording       a kept trial: the road second by second, and what the agent did
bodies          what SUMO does not say of a vehicle's body
opendrive       its road as OpenDRIVE
openscenario    its traffic, lights, weather and acts as OpenSCENARIO XML
osi             all of it as a trace of OSI ground truth
ssam            its traffic as SSAM's trajectories
trajectories    its traffic as SUMO's FCD, CSV and Parquet
demonstrations  what the rule-perfect watcher and the oracle do in the flat environments, as Parquet
tree            an XML file as a tree that knows its lines
incoming        OpenSCENARIO XML as a scenario
"""
