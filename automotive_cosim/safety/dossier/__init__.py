"""What a safety engineer files about a run: facts of the run in sections, tables and a tree of claims.

It says what was run, in which part of the operational domain, what was met and missed, how critical it was, what
was not seen and how often that may happen, and with which versions. The claims use the terms of ISO 34502
(reasonably foreseeable and preventable scenarios) and ISO 21448, SOTIF (known and unknown, hazardous and not). No
claim of compliance with either is made.

subject     the trials that it is about
domain      item, intended use, operational domain, exposure
happened    events, failures, measures
unseen      bounds
provenance  versions, hashes, limits
claims      the tree of claims
document    all sections
filing      page, PDF and data
"""
