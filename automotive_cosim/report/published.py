"""Figures that others have published, shown in a separate block of the report."""

from __future__ import annotations

PAPER = "Automotive-ENV, arXiv 2509.21143, table 3: success rates in per cent, without intervals or numbers of runs"
PAPER_COLUMNS = (
    "Base model",
    "Method",
    "Input",
    "Explicit control",
    "Implicit intent",
    "Driving alignment",
    "Environment alerts",
)
EDITION_2026 = (
    "The authors' newer edition: 420 tasks, at most ten steps, success rates in per cent as they publish them"
)
EDITION_2026_ROWS: tuple[tuple[str, float, float, float, float], ...] = (
    ("Number of tasks", 57, 83, 80, 200),
    ("People", 93.3, 85.3, 91.8, 89.3),
    ("Best model", 75.8, 56.3, 29.7, 35.4),
)
"""By subset, in the order of ``tasking.task.Subset``."""
TREE, SCREEN, GPS = "a11y tree", "a11y tree + screen", "a11y tree + screen + GPS"
PAPER_ROWS: tuple[tuple[str, str, str, float, float, float, float], ...] = (
    ("none", "Human", "screen", 90.0, 82.0, 100.0, 88.0),
    ("GPT-4o-Mini", "T3A", TREE, 43.1, 5.2, 45.0, 55.0),
    ("GPT-4o-Mini", "M3A", SCREEN, 52.1, 13.6, 50.0, 55.0),
    ("GPT-4o-Mini", "ASURADA", GPS, 52.3, 14.2, 60.0, 65.0),
    ("Gemini 1.5 Pro", "T3A", TREE, 30.0, 38.0, 55.0, 80.0),
    ("Gemini 1.5 Pro", "M3A", SCREEN, 40.0, 33.3, 55.0, 80.0),
    ("Gemini 1.5 Pro", "ASURADA", GPS, 43.3, 33.3, 90.0, 90.0),
    ("Gemini 1.5 Flash", "T3A", TREE, 43.3, 28.5, 55.0, 45.0),
    ("Gemini 1.5 Flash", "M3A", SCREEN, 46.6, 33.3, 75.0, 55.0),
    ("Gemini 1.5 Flash", "ASURADA", GPS, 46.6, 33.3, 90.0, 85.0),
    ("Gemini 2.0 Flash", "T3A", TREE, 30.0, 38.1, 65.0, 55.0),
    ("Gemini 2.0 Flash", "M3A", SCREEN, 43.3, 38.0, 65.0, 45.0),
    ("Gemini 2.0 Flash", "ASURADA", GPS, 46.6, 45.7, 90.0, 70.0),
    ("Gemini 2.0 Flash-Lite", "T3A", TREE, 43.3, 32.8, 50.0, 60.0),
    ("Gemini 2.0 Flash-Lite", "M3A", SCREEN, 33.3, 33.3, 42.8, 60.0),
    ("Gemini 2.0 Flash-Lite", "ASURADA", GPS, 40.0, 35.0, 90.0, 60.0),
)
