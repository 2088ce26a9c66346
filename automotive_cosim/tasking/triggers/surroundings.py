"""Sky, place, position fix and connection."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.triggers.base import ANY


@dataclass(frozen=True, slots=True)
class VisibilityBetween:
    """Visibility within a range in metres, the upper end excluded."""

    from_m: float
    to_m: float

    def __call__(self, moment: Moment) -> bool:
        return self.from_m <= moment.weather.visibility < self.to_m

    def __str__(self) -> str:
        return "visibility " + _range(self.from_m, self.to_m, "m")


@dataclass(frozen=True, slots=True)
class RainBetween:
    """Precipitation within a range in mm/h, the upper end excluded."""

    from_mm_h: float
    to_mm_h: float = ANY

    def __call__(self, moment: Moment) -> bool:
        return self.from_mm_h <= moment.weather.precipitation < self.to_mm_h

    def __str__(self) -> str:
        return _range(self.from_mm_h, self.to_mm_h, "mm/h") + " of rain or snow"


@dataclass(frozen=True, slots=True)
class AirBetween:
    """Outside temperature within a range in degrees Celsius, the upper end excluded."""

    from_c: float
    to_c: float

    def __call__(self, moment: Moment) -> bool:
        return self.from_c <= moment.weather.temperature_2m < self.to_c

    def __str__(self) -> str:
        return f"{self.from_c:g} to {self.to_c:g} degrees outside"


@dataclass(frozen=True, slots=True)
class Dark:
    """Between sunset and sunrise, or not."""

    dark: bool = True

    def __call__(self, moment: Moment) -> bool:
        return moment.context.sun is not None and moment.context.sun.is_set is self.dark

    def __str__(self) -> str:
        return "in the dark" if self.dark else "by day"


@dataclass(frozen=True, slots=True)
class InCountry:
    """In a country (ISO 3166-1 code)."""

    code: str

    def __call__(self, moment: Moment) -> bool:
        return moment.context.country == self.code

    def __str__(self) -> str:
        return f"in {self.code}"


@dataclass(frozen=True, slots=True)
class GpsLost:
    """The receiver has no fix."""

    def __call__(self, moment: Moment) -> bool:
        return moment.gps is not None and not moment.gps.has_fix

    def __str__(self) -> str:
        return "no GPS"


@dataclass(frozen=True, slots=True)
class Offline:
    """The car has no link to the outside."""

    def __call__(self, moment: Moment) -> bool:
        return not moment.connectivity.online

    def __str__(self) -> str:
        return "no connection"


def _range(low: float, high: float, unit: str) -> str:
    return f"{low:g} {unit} or more" if high == ANY else f"{low:g} to {high:g} {unit}"
