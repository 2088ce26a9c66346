"""The safety report: made-up drives, whose figures are known."""

import csv
import json
from dataclasses import asdict, replace
from importlib.util import find_spec
from math import isclose, log, sqrt
from pathlib import Path

import pytest

from automotive_cosim.contracts.plain import counted
from automotive_cosim.drives.harm import Harm
from automotive_cosim.drives.judge import EventOutcome, JudgedEvent
from automotive_cosim.drives.score import together
from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import STEPS, TRIAL
from automotive_cosim.measures.exposure import ExposureCell
from automotive_cosim.measures.following import FollowingFigures
from automotive_cosim.report.stats import rate_upper_bound
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import kind_of
from automotive_cosim.run.store import opened
from automotive_cosim.safety.dossier.claims import claims
from automotive_cosim.safety.dossier.document import dossier
from automotive_cosim.safety.dossier.filing import write_dossier
from automotive_cosim.safety.dossier.subject import Subject, failing, read_subject
from automotive_cosim.safety.dossier.unseen import missing_mass
from automotive_cosim.safety.space import FailureRule

CELLS = (
    ExposureCell("primary", "dry", "day", "30 to 50", 0.3, 12.0),
    ExposureCell("primary_link", "fog", "day", "0 to 30", 0.1, 2.0),
)
NOTHING = together([])


def event(kind: str, outcome: EventOutcome) -> JudgedEvent:
    alike = outcome in (EventOutcome.AVOIDED, EventOutcome.TAKEN)
    return JudgedEvent(kind, "", alike, 1.0, outcome, 10.0, 12.0, 20.0, 30.0, 13.0)


def run(folder: Path, missed: int, agents: tuple[str, ...] = ("asurada",)) -> Path:
    """Six drives an agent of 0.4 h each, with two events and a look-alike; ``missed`` of them miss an event."""
    plan = make_plan({"agents": list(agents), "drives": ["grid_june"], "seeds": list(range(6))})
    jobs = plan.jobs()
    with opened(folder, plan.as_json(), kind_of, planned=len(jobs)) as store:
        for number, job in enumerate(jobs):
            lost = number % 6 < missed
            outcomes = EventOutcome.HIT, EventOutcome.MISSED if lost else EventOutcome.HIT, EventOutcome.AVOIDED
            kinds = "over_limit", "tunnel", "blue_light"
            score = replace(NOTHING, events=2, hits=2 - lost, missed=int(lost), driven_s=1440.0)
            store.append(
                replace(
                    job.planned(),
                    score=score,
                    value=50.0 if lost else 100.0,
                    events=tuple(map(event, kinds, outcomes)),
                    exposure=CELLS,
                    measures=FollowingFigures(
                        2.0 if lost else 8.0, 1.0, 1.0, 1.5, 3.0 * lost, 1.0 * lost, None, 0.0
                    ),
                    harm=Harm(1440.0, 14_000.0, 0.0, 0.0, 0.0, False),
                    trace_sha256="0" * 64,
                )
            )
    return folder


def table(folder: Path, name: str) -> list[dict[str, str]]:
    return list(csv.DictReader((folder / "safety/data" / f"{name}.csv").read_text("utf-8").splitlines()))


def shown(subject: Subject) -> str:
    (summary,) = [section for section in dossier(subject).sections if section.name == "summary"]
    return summary.told[0]


@pytest.mark.slow
def test_figures_are_those_of_the_rows(tmp_path: Path) -> None:
    page, pdf = write_dossier(run(tmp_path / "runs", missed=2))
    folder = tmp_path / "runs"
    domain = {(row["Attribute"], row["Value"]): row for row in table(folder, "domain")}
    assert domain["Place", "grid"]["Runs"] == "6"
    assert [row["Value"] for row in table(folder, "domain") if row["Runs"] == "none" and row["Attribute"] in
            ("Place", "Language", "Weather")] == ["rain, snow or ice"]  # fmt: skip
    assert domain["Road", "primary"]["Hours"] == "2.40"
    assert domain["Weather", "fog"]["Kilometres"] == "12.0"
    events = {row["Kind"]: row for row in table(folder, "events")}
    assert (events["tunnel"]["Due"], events["tunnel"]["Missed"]) == ("6", "2")
    assert events["tunnel"]["Met % (interval)"].startswith("67 (")
    assert events["blue_light"]["Look-alikes left"] == "6 of 6"
    assert len(table(folder, "failures")) == 2
    listed = [(row["When"], row["What"], row["Event or act"]) for row in table(folder, "faults")]
    assert listed == [("0:12", "missed", "tunnel")] * 2
    assert "due from 0:12 to 0:20" in table(folder, "faults")[0]["Why"]
    measures = {row["Measure"]: row for row in table(folder, "measures")}
    assert measures["Min TTC ahead, s"]["Critical runs, or interval"].startswith("≤ 3: 2 of 6")
    assert measures["TET ahead, s/h"]["Median or rate"] == "2.50"
    text = page.read_text("utf-8")
    assert "no claim of compliance" in text
    assert all(f'id="{name}"' in text for name in ("domain", "events", "unseen", "claims"))
    if find_spec("typst") is not None:
        assert pdf is not None
        assert pdf.read_bytes().startswith(b"%PDF")
    assert not list((folder / "safety/data").glob("*.typ"))
    assert json.loads((folder / "safety/data/report.json").read_text("utf-8"))["title"].startswith("Safety report")


@pytest.mark.parametrize(("missed", "root", "acts"), [(0, "limited", "supported"), (1, *["contradicted"] * 2)])
def test_claims_follow_from_the_rows(tmp_path: Path, missed: int, root: str, acts: str) -> None:
    subject = read_subject(run(tmp_path / "runs", missed))
    tree = claims(subject)
    assert (tree.status, tree.parts[0].status) == (root, acts)
    names = {section.name for section in dossier(subject).sections}
    assert all(part.section in names for part in (tree, *tree.parts))
    assert all(part.status in ("supported", "contradicted", "limited", "not examined") for part in tree.parts)
    bad, total, upper = failing(subject)
    assert (bad, total) == (missed, 6)
    assert 0.3 < upper < 0.6


def test_drives_with_nothing_due_neither_pass_nor_fail(tmp_path: Path) -> None:
    """Of six drives, one fails and five have nothing due."""
    subject = read_subject(run(tmp_path / "runs", 1))
    empty = replace(NOTHING, driven_s=1440.0)
    rows = tuple(row if row.missing else replace(row, score=empty, events=()) for row in subject.drives)
    subject = replace(subject, rows=rows)
    assert (len(subject.passed), len(subject.failed), len(subject.nothing_due)) == (0, 1, 5)
    assert failing(subject)[:2] == (1, 1)
    told = [paragraph for section in dossier(subject).sections for paragraph in section.told]
    assert (
        "asurada failed in 1 of 1 run in which something was due; in 5 more nothing was due (2.40 h driven)."
        in told
    )
    assert "something was due in 1 of them" in dossier(subject).sentence
    nothing = replace(subject, rows=tuple(row for row in rows if not row.missing))
    assert failing(nothing) == (0, 0, 1.0)
    assert claims(nothing).status == "limited"


def test_a_search_counts_the_kinds_of_its_space_alone(tmp_path: Path) -> None:
    """Two of six drives miss a tunnel; the space names another kind, and then the tunnel."""
    findings = {"failures": [], "failure_rate_upper": None, "unseen_rate_upper": None, "pairs_covered": 0}
    subject = read_subject(run(tmp_path / "runs", 2))
    other, same = (
        replace(subject, findings=findings | {"rule": asdict(FailureRule(events=(kind,)))})
        for kind in ("over_limit", "tunnel")
    )
    assert [len(each) for each in (other.failed, other.failed_beside, other.passed)] == [0, 2, 6]
    assert [len(each) for each in (same.failed, same.failed_beside, same.passed)] == [2, 0, 4]
    assert "nuisances than right acts, of: over limit. Of the others, 2 failed in what" in shown(other)
    tables = {table.name: table for section in dossier(other).sections for table in section.tables}
    assert [row[0] for row in tables["events"].rows] == ["over_limit"]
    assert {row[0] for row in tables["events_beside"].rows} == {"tunnel", "blue_light"}
    assert "faults" not in tables
    assert len(tables["faults_beside"].rows) == 2
    assert not any("%" in column for name in ("events", "events_beside") for column in tables[name].columns)


def test_a_search_counts_its_samples_and_no_rates_that_no_row_explains(tmp_path: Path) -> None:
    """Of six trials, two miss the tunnel; one of those repeats the other."""
    findings = {"failures": [], "failure_rate_upper": None, "unseen_rate_upper": None, "pairs_covered": 0}
    subject = read_subject(run(tmp_path / "runs", 2))
    sampled = [row.id for row in subject.rows[1:]]
    rule = asdict(FailureRule(events=("tunnel",)))
    search = replace(subject, findings=findings | {"rule": rule, "sampled_trials": sampled})
    made = dossier(search)
    assert shown(search).startswith(
        "asurada failed in 1 of 5 runs in which something was due (2.00 h driven). Not counted: 1 run to repeat"
    )
    tables = {table.name: table for section in made.sections for table in section.tables}
    assert {row[1] for row in tables["events"].rows} == {"5"}
    assert len(tables["failures"].rows) == len(tables["faults"].rows) == 1
    (quiet,) = [part for part in claims(search).parts if "disturb" in part.text]
    assert "an hour" not in quiet.evidence
    (quiet,) = [part for part in claims(subject).parts if "disturb" in part.text]
    (row,) = [row for section in dossier(subject).sections for table in section.tables for row in table.rows
              if table.name == "unseen" and str(row[0]).startswith("Nuisances")]  # fmt: skip
    bound = quiet.evidence.partition("at most ")[2].removesuffix(" an hour.")
    assert f"at most {bound}" in str(row[1])


@pytest.mark.parametrize("trials", [1, 4, 5, 6])
def test_few_trials_leave_a_claim_limited_and_the_report_leads_with_what_is_open(
    tmp_path: Path, trials: int
) -> None:
    subject = read_subject(run(tmp_path / "runs", 0))
    made = replace(subject, rows=subject.rows[:trials])
    assert claims(made).parts[0].status == ("supported" if trials >= 5 else "limited")
    first = dossier(made).sections[0]
    assert first.title == "What was not shown"
    driven, never, residual = first.told
    assert driven == f"{0.4 * trials:.2f} h and {14 * trials} km were driven in {counted(trials, 'run')}; " + (
        f"something was due in {trials} of them."
    )
    assert "weather rain, snow or ice;" in never
    assert residual.startswith("Up to ")


def test_a_drive_alone_has_a_report(tmp_path: Path) -> None:
    row = read_subject(run(tmp_path / "runs", 1)).rows[0]
    alone = tmp_path / "alone"
    alone.mkdir()
    (alone / STEPS).write_text("")
    (alone / TRIAL).write_text(json.dumps({"row": as_json(row)}))
    subject = read_subject(alone)
    assert [each.id for each in subject.failed] == [row.id]
    page, _ = write_dossier(alone)
    assert "of 1 run in which something was due" in page.read_text("utf-8")


def test_a_minimal_case_contradicts_although_no_sample_failed(tmp_path: Path) -> None:
    case = {"words": "everything nominal", "why": "tunnel missed", "act": "no act at 0:12", "beside": ""}
    findings = {"failures": [case], "failure_rate_upper": 0.4, "unseen_rate_upper": 0.4, "pairs_covered": 0}
    rule = asdict(FailureRule(events=("tunnel",)))
    subject = replace(read_subject(run(tmp_path / "runs", 0)), findings=findings | {"rule": rule})
    assert claims(subject).parts[0].status == "contradicted"
    assert shown(subject).startswith(
        "asurada fails with everything nominal. Beside that, asurada failed in none of 6 "
    )
    (section,) = [section for section in dossier(subject).sections if section.name == "failures"]
    assert "no act at 0:12" in section.tables[0].rows[0]
    assert not section.told


def test_an_agent_must_be_named_if_there_are_several(tmp_path: Path) -> None:
    folder = run(tmp_path / "runs", 0, ("asurada", "m3a", "rule-perfect"))
    with pytest.raises(UserError, match="several agents; give --agent with one of asurada, m3a, rule-perfect"):
        read_subject(folder)
    subject = read_subject(folder, "asurada")
    assert len(subject.rows) == len(subject.reference) == 6
    with pytest.raises(UserError, match="no run of agent 'me'"):
        read_subject(folder, "me")
    assert subject.others == ["m3a", "rule-perfect"]
    assert read_subject(run(tmp_path / "two", 0, ("asurada", "rule-perfect"))).others == ["rule-perfect"]


def test_bounds_are_their_closed_forms() -> None:
    assert isclose(rate_upper_bound(0, 10.0), -log(0.05) / 10)
    assert 0.29 < rate_upper_bound(0, 10.0) < 3 / 10
    assert isclose(rate_upper_bound(40, 20 / 3), 53.0 / (20 / 3), rel_tol=0.05)
    share, upper = missing_mass([1, 1, 998])
    assert share == 2 / 1000
    assert isclose(upper, share + (2 * sqrt(2) + sqrt(3)) * sqrt(log(60) / 1000))
    assert missing_mass([]) == (1.0, 1.0)
