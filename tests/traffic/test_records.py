"""Quickly made records are the frozen dataclasses themselves."""

import pickle
from dataclasses import FrozenInstanceError, fields, replace

import pytest

from automotive_cosim.contracts import (
    Around,
    DrivingState,
    OtherVehicle,
    RoadAhead,
    RoadHere,
    SeenVehicle,
    TrafficLight,
)
from automotive_cosim.traffic.records import maker


@pytest.mark.parametrize(
    "kind", [Around, DrivingState, OtherVehicle, RoadAhead, RoadHere, SeenVehicle, TrafficLight]
)
def test_a_quick_record_is_the_class_itself(kind: type) -> None:
    values = tuple(f"value {number}" for number in range(len(fields(kind))))
    quick, usual = maker(kind)(*values), kind(*values)
    assert type(quick) is kind
    assert quick == usual
    assert hash(quick) == hash(usual)
    assert repr(quick) == repr(usual)
    assert pickle.loads(pickle.dumps(quick)) == usual
    first = fields(kind)[0].name
    assert replace(quick, **{first: "another"}) == replace(usual, **{first: "another"})
    with pytest.raises(FrozenInstanceError):
        setattr(quick, first, "another")
    with pytest.raises(TypeError):
        maker(kind)(*values, "one too many")
