"""The taskset's name for verifiers, which finds tasksets as modules at the top."""

from automotive_cosim.doors.verifiers import CockpitTaskset

__all__ = ["CockpitTaskset"]
