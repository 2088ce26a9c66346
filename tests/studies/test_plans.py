"""The plan of every study: what cannot be run is refused in a line, and what was run is read back."""

from dataclasses import replace

import pytest

from automotive_cosim.contracts import Json
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.studies.adoption.adoption import AdoptionPlan
from automotive_cosim.studies.congestion.plan import CongestionPlan
from automotive_cosim.studies.days.days import DaysPlan
from automotive_cosim.studies.plan import plan_of
from automotive_cosim.studies.reroute.plan import StudyPlan
from automotive_cosim.studies.settings import TrafficSettings
from tests.laws import over

REROUTE = StudyPlan("grid", shares=(0.0, 1.0), half_width_s=3.0, policies=("never", "agent:asurada"))
AUTO = replace(REROUTE, replicates="auto", together=(0.0, 0.5))
PLANS = (
    REROUTE,
    AUTO,
    CongestionPlan("grid", interventions=("closure edge=c1c2",), demand=(1.0, 2.0), step_s=0.1),
    DaysPlan("grid", shares=(0.0, 1.0), seeds=(0, 1)),
    AdoptionPlan("grid", seeds=(0, 1), minutes=2.0, warm_up_s=120.0, shares=(0.0, 50.0, 100.0)),
)
WRONG: tuple[tuple[TrafficSettings, tuple[tuple[Json, str], ...]], ...] = (
    (
        StudyPlan("paris_centre"),
        (
            ({"scenario": "pari_centre"}, "paris_centre"),
            ({"trips": ("jamm",)}, "jam"),
            ({"via": "stop"}, "no via named"),
            ({"incidents": ("closure edge=pont_neuff.1",)}, "edge for cars in --incident"),
            ({"policies": ("sometimes",)}, "policy"),
            ({"policies": ()}, "--policies is empty"),
            ({"shares": (1.5,)}, "--shares is 1.5"),
            ({"ages_s": (-1.0,)}, "--ages"),
            ({"ages_s": (5000.0,)}, "--ages"),
            ({"compliance": (2.0,)}, "--compliance is 2"),
            ({"compliance": ()}, "--compliance is empty"),
            ({"compliance": (0.5, 0.5)}, "twice"),
            ({"departures_s": (0.0, 0.0)}, "twice"),
            ({"step_s": 5.0}, "--step"),
            ({"policies": ("agent:asurado",)}, "asurada"),
            ({"policies": ("agent:asurada/nothing",)}, "nothing"),
            ({"policies": ("agent:human",)}, "person"),
            ({"replicates": 0}, "--replicates is 0"),
            ({"replicates": "many"}, "'auto'"),
            ({"together": (1.5,)}, "--together"),
            ({"together": (0.5, 0.5)}, "twice"),
            ({"arrived": 0.1}, "arrived"),
            ({"ego_class": "Energy default"}, "emission class"),
        ),
    ),
    (
        CongestionPlan("grid"),
        (
            ({"scenario": "grit"}, "grid"),
            ({"interventions": ("closure edge=zz",)}, "edge for cars in --intervention"),
            ({"interventions": ("closures edge=c1c2",)}, "did you mean 'closure'"),
            ({"interventions": ("advice share=2",)}, "share is 2"),
            ({"interventions": ("signals control=green",)}, "control"),
            ({"interventions": ("emergency",)}, "needs the ego"),
            ({"interventions": ("advice share=1", "advice share=1")}, "twice"),
            ({"incidents": ("advice share=1",)}, "kind in --incident"),
            ({"minutes": 7.0}, "multiple of 5"),
            ({"minutes": 10.0, "demand": (1.0, 2.0, 1.0)}, "--demand has 3 periods"),
            ({"seeds": ()}, "--seeds is empty"),
        ),
    ),
    (
        DaysPlan("grid"),
        (
            ({"scenario": "grit"}, "grid"),
            ({"shares": (0.5, 0.5)}, "twice"),
            ({"shares": (1.5,)}, "--shares is 1.5"),
            ({"memory": 2.0}, "--memory is 2"),
            ({"days": 1}, "--days is 1"),
        ),
    ),
    (
        AdoptionPlan("grid"),
        (
            ({"agent": "best"}, "best"),
            ({"agent": "nobody"}, "nobody"),
            ({"shares": (5.0, 5.0)}, "--shares"),
            ({"shares": (101.0,)}, "--shares"),
            ({"driver": "averag"}, "average"),
            ({"incidents": ("breakdown edge=nowhere position_m=1",)}, "nowhere"),
        ),
    ),
)
"""Of a plan that can be run, what makes it one that cannot, and what is said of it."""


@over([(plan, wrong, told) for plan, each in WRONG for wrong, told in each])
def test_a_plan_that_cannot_be_run_is_refused_in_a_line(plan: TrafficSettings, wrong: Json, told: str) -> None:
    with pytest.raises(CosimError, match=told) as refused:
        replace(plan, **wrong).check()  # type: ignore[attr-defined]
    assert "\n" not in str(refused.value)


@over([(plan,) for plan in PLANS])
def test_a_plan_comes_back_from_its_manifest(plan: TrafficSettings) -> None:
    assert plan_of(type(plan), plan.as_json()) == plan


def test_another_kind_of_folder_is_no_study() -> None:
    with pytest.raises(UserError, match="no reroute study"):
        plan_of(StudyPlan, {"agents": ["oracle"]})


def test_replicates_set_how_many_draws_are_added() -> None:
    assert (AUTO.draws.start, AUTO.draws.stop) == (4, 14)
    assert [replace(REROUTE, replicates=count).draws.stop for count in (1, 4)] == [0, 3]
