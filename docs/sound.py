"""How loud the cabin is, drawn: ``python -m docs.sound`` writes ``docs/images/cabin.svg`` anew."""

from __future__ import annotations

from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from automotive_cosim.cockpit.signals import CATALOGUE, HVAC, MEDIA
from automotive_cosim.voice.cabin import OPENINGS, driver_snr_db, levels, summed_db

SPEEDS, SHARES = range(0, 151, 2), range(0, 101, 2)
CARS = {
    "all shut": {},
    "heavy rain (20 mm/h)": {},
    "one window open": {OPENINGS[0].path: 100.0},
    "four windows open": {each.path: 100.0 for each in OPENINGS[:4]},
    "blower at full speed": {HVAC.FAN_SPEED.path: 100.0},
    "music at full volume": {MEDIA.ACTION.path: "PLAY", MEDIA.VOLUME.path: 100.0},
}
SET = {
    "one window, at 80 km/h": (80, OPENINGS[:1], {}),
    "four windows, at 80 km/h": (80, OPENINGS[:4], {}),
    "blower, at 80 km/h": (80, (HVAC.FAN_SPEED,), {}),
    "blower, standing": (0, (HVAC.FAN_SPEED,), {}),
    "music's volume, standing": (0, (MEDIA.VOLUME,), {MEDIA.ACTION.path: "PLAY"}),
}
"""Speed, and what is set to each share."""


def main() -> None:
    """Draws level and ratio over speed, and level over what is set."""
    matplotlib.rcParams["svg.hashsalt"] = "cabin"
    usual = {path: signal.default for path, signal in CATALOGUE.items()} | {HVAC.FAN_SPEED.path: 20.0}
    figure = Figure((11.0, 3.6), layout="constrained")
    loud, clear, parts = figure.subplots(1, 3)
    for name, changed in CARS.items():
        rain_mm_h = 20.0 if "rain" in name else 0.0
        noise_db = [summed_db(levels(usual | changed, kmh, rain_mm_h)) for kmh in SPEEDS]
        loud.plot(SPEEDS, noise_db, label=name)
        clear.plot(SPEEDS, list(map(driver_snr_db, noise_db)), label=name)
    loud.set(xlabel="speed, km/h", ylabel="level in the cabin, dB(A)")
    clear.set(xlabel="speed, km/h", ylabel="driver's voice above it, dB")
    for name, (kmh, signals, changed) in SET.items():
        found = ({each.path: float(share) for each in signals} for share in SHARES)
        parts.plot(SHARES, [summed_db(levels(usual | changed | each, kmh)) for each in found], label=name)
    parts.set(xlabel="opening, blower or volume, %", ylabel="level in the cabin, dB(A)")
    for axes, most in ((loud, 150), (clear, 150), (parts, 100)):
        axes.grid(alpha=0.3)
        axes.set_xlim(0, most)
    loud.legend(fontsize=7)
    parts.legend(fontsize=7)
    about = {"Date": None, "Creator": None}
    figure.savefig(Path(__file__).parent / "images" / "cabin.svg", metadata=about)


if __name__ == "__main__":
    main()
