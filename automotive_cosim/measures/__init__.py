"""How critical a drive was, and how much was driven in which conditions: each measure is defined once, here."""

from automotive_cosim.measures.encounters import Encounter, EncounterKind, PairReading, encounters, pair_readings
from automotive_cosim.measures.exposure import DriveStretch, ExposureCell, exposure
from automotive_cosim.measures.following import FollowingFigures, following_figures, nearest_s
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS, Thresholds

__all__ = [
    "DEFAULT_THRESHOLDS",
    "DriveStretch",
    "Encounter",
    "EncounterKind",
    "ExposureCell",
    "FollowingFigures",
    "PairReading",
    "Thresholds",
    "encounters",
    "exposure",
    "following_figures",
    "nearest_s",
    "pair_readings",
]
