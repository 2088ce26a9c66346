"""Recorded conversations of small episodes, one for every native format and for T3A, M3A and ASURADA, which play
without a model: ``--model replay/NAME``. ``make`` makes them anew.

    {"episode": {...}, "agent": name, "end": ..., "success": ..., "sees_pictures": ..., "answers": [...]}

An answer has the digest of its question's text and the body that the model's provider sends.
"""
