"""What studies add to the package: their commands, and their kinds of results folder."""

from __future__ import annotations

from automotive_cosim.cli import RUN
from automotive_cosim.run.extensions import ResultsKind

COMMANDS = (
    ("study", "automotive_cosim.studies.commands:app", RUN),
    ("scenarios calibrate", "automotive_cosim.studies.commands.calibrate:calibrate_scenario", ""),
    ("scenarios equilibrate", "automotive_cosim.studies.commands.equilibrate:equilibrate_scenario", ""),
)
"""As in the command line."""


def kinds() -> dict[str, ResultsKind]:
    """By their words under ``study``; a command that reads no results does without the settings."""
    from automotive_cosim.studies.settings import HOME, NETWORKS, AdoptionSettings, RerouteSettings

    served = {"": f"{HOME}.adoption.served:shares", "cars": f"{HOME}.adoption.served:cars"}
    decisions = {"": f"{HOME}.reroute.served:decisions", "decisions": f"{HOME}.reroute.served:decision_map"}
    return {
        RerouteSettings.kind: ResultsKind(
            f"{HOME}.reroute.page:write_study", "drive", f"{HOME}.reroute.decisions:attributed", decisions
        ),
        **{
            kind: ResultsKind(
                f"{HOME}.content:write_report", unit, served=served if kind == AdoptionSettings.kind else {}
            )
            for kind, (_, _, unit) in NETWORKS.items()
        },
    }
