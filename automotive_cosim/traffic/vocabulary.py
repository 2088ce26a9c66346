"""What SUMO's files may say here: its options, elements and device parameters, each taken, left out or refused.

SUMO writes wherever its configuration, its detectors and its vehicles tell it to. Of these tables only what is
taken reaches it, and what no table knows is refused; a test compares them with the installed SUMO.
"""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.formats.shipped import shipped_table

_TOLD = shipped_table("traffic", "vocabulary.toml")


def _words(text: str) -> Mapping[str, str]:
    """Every name and synonym of ``name/synonym/...``, with the name that SUMO's documentation uses."""
    return {word: each.partition("/")[0] for each in text.split() for word in each.split("/")}


TAKEN = _words(_TOLD["taken"])
"""Options that a configuration may set."""

IGNORED = _words(_TOLD["ignored"])
"""Options without effect here: outputs, reports, the window, and what a run sets itself. SUMO does not read a
configuration inside a configuration either."""

PARALLEL = _words("threads device.rerouting.threads/routing-threads")
"""Options that make SUMO work in parallel. A copy by fork has the thread that forks and no other, and waits for the
rest for ever (seen in SUMO 1.28), so they are set aside."""

WINDOW = _words("osg-view")
"""Options without effect here that SUMO knows only where its window is built with them."""

MESOSCOPIC = "mesosim"
"""The option of the mesoscopic model, whose vehicles are in no lane: nobody can drive among them."""

REFUSED = _words(_TOLD["refused"])
"""Options that name files of other forms, which are not checked."""

DEVICE_PARAMETERS = frozenset(_words(_TOLD["device_parameters"]))
"""Parameters of vehicles and their types, besides the options."""

DEVICES = frozenset(name.split(".")[1] for name in (*TAKEN, *IGNORED) if name.endswith(".probability"))
"""The ``*`` of ``has.*.device``."""

ELEMENTS = frozenset(_words(_TOLD["elements"]))
"""Elements of networks, routes and additional files."""

OUTPUTS: Mapping[str, str] = {
    **dict.fromkeys(
        _words(
            "e1Detector inductionLoop e2Detector laneAreaDetector e3Detector entryExitDetector "
            "instantInductionLoop edgeData laneData routeProbe vTypeProbe"
        ),
        "file",
    ),
    "calibrator": "output",
    "timedEvent": "dest",
}
"""Elements that write, with the attribute that says where."""

INPUTS: Mapping[str, str] = {
    "include": "href",
    **dict.fromkeys(("variableSpeedSign", "rerouter", "calibrator"), "file"),
    **dict.fromkeys(("edgeData", "laneData"), "edgesFile"),
}
"""Elements that read a file, with the attribute that names it."""

WRITING_LIGHT = "file"
"""The parameter with which a traffic light's detectors write."""

LOGGING_LIGHT = "SWARMLOG"
"""The parameter with which a traffic light of type ``swarm`` opens a log; ``NUL`` would be a file of that name."""


def parameter(key: str) -> bool | None:
    """Whether a parameter is taken; None if it is left out, since SUMO would write.

    Raises KeyError: it is a device's, and unknown."""
    if key == LOGGING_LIGHT:
        return None
    if not key.startswith(("device.", "person-device.", "has.")):
        return True
    if key.startswith("has."):
        device = key.removeprefix("has.").removesuffix(".device")
        if device not in DEVICES or not key.endswith(".device"):
            raise KeyError(key)
        return None if device == "ssm" else True
    if key in TAKEN or key in DEVICE_PARAMETERS:
        return True
    if key in IGNORED or key in PARALLEL:
        return None
    raise KeyError(key)
