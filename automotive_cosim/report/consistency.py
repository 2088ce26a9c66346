"""How reliable a contestant is over repeats of the same instance: pass^k, pass@k, and where its runs part."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest

from automotive_cosim.contracts import Json
from automotive_cosim.report.results import Results
from automotive_cosim.report.stats import all_pass, any_passes, clustered_mean, wilson
from automotive_cosim.report.summary import DIMENSIONS, NONE
from automotive_cosim.report.tables import Cell, Table, TableRow
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import read_trace, trace_file

ATTEMPTS = (1, 3, 5)
"""The k that are customary (tau-bench reports pass^1 to pass^4, code generation pass@1 and more)."""
LONGEST = 40
"""Characters of an action in the table of what parts."""

Repeats = Mapping[Hashable, Sequence[EpisodeRow]]
PassShare = Callable[[Sequence[bool], int], float | None]


def consistency(results: Results) -> Table:
    """pass^k and pass@k of each contestant, over all tasks and by dimension, if anything was repeated."""
    most = int(results.manifest["plan"]["repeats"])
    ks = [k for k in ATTEMPTS if k <= most] if most >= ATTEMPTS[1] else list(range(1, most + 1))
    rows: list[TableRow] = []
    for each in results.contestants if most > 1 else ():
        mine = [row for row in results.of(each) if row.success is not None]
        for title, of_it in (("All", mine), *((title, _of(mine, name)) for name, title in DIMENSIONS.items())):
            if of_it:
                repeats, ids = _instances(of_it), tuple(row.id for row in of_it)
                rows.append(
                    (
                        each.label,
                        title,
                        str(len(repeats)),
                        *(Cell(_share(repeats, all_pass, k), ids) for k in ks),
                        *(Cell(_share(repeats, any_passes, k), ids) for k in ks[1:]),
                    )
                )
    columns = ("Contestant", "Dimension", "Episodes", *(f"pass^{k}" for k in ks), *(f"pass@{k}" for k in ks[1:]))
    note = (
        "The probability that all of k runs of an episode succeed (pass^k), and that one of them does (pass@k), "
        "in per cent with a 95 % bootstrap interval over tasks, or Wilson's if all tasks agree. Each seed is an "
        "episode of its own."
    )
    return Table("repeats", "Reliability over repeats", columns, tuple(rows), note, heads=2)


def varied(results: Results) -> Table:
    """The instances whose repeats did not end alike, with the first action in which a lost run left a won one."""
    rows: list[TableRow] = []
    for each in results.contestants:
        for repeats in _instances(row for row in results.of(each) if row.success is not None).values():
            won, lost = ([row for row in repeats if row.has_succeeded is kept] for kept in (True, False))
            if won and lost:
                step, winning, losing = _parting(results, won[0], lost[0])
                instance = f"{won[0].task}, {won[0].half} half, seed {won[0].seed}"
                ids = tuple(row.id for row in repeats)
                rows.append(
                    (each.label, Cell(instance, ids), f"{len(won)} of {len(repeats)}", step, winning, losing)
                )
    columns = ("Contestant", "Episode", "Succeeded", "Step", "A run that succeeded", "A run that did not")
    note = "The first step in which the actions of the first such run of each kind differ."
    return Table("varied", "Where repeats part", columns, tuple(rows), note, heads=2)


def pass_hats(rows: Iterable[EpisodeRow], most: int) -> list[float | None]:
    """pass^k of one contestant for k from 1 to ``most``, over the instances of its judged episodes; None without
    an instance of k."""
    instances = _instances(row for row in rows if row.success is not None).values()
    outcomes = [[row.has_succeeded for row in repeats] for repeats in instances]
    found: list[float | None] = []
    for k in range(1, most + 1):
        shares = [share for each in outcomes if (share := all_pass(each, k)) is not None]
        found.append(sum(shares) / len(shares) if shares else None)
    return found


def pass_hat(rows: Iterable[EpisodeRow], k: int) -> str:
    """pass^k of a contestant's judged episodes with its interval, in words; a dash for one run of each."""
    return _share(_instances(rows), all_pass, k) if k > 1 else NONE


def _of(rows: Sequence[EpisodeRow], dimension: str) -> list[EpisodeRow]:
    return [row for row in rows if row.dimension == dimension]


def _instances(rows: Iterable[EpisodeRow]) -> Repeats:
    found: dict[Hashable, list[EpisodeRow]] = defaultdict(list)
    for row in rows:
        found[row.instance[:-1]].append(row)
    return found


def _share(repeats: Repeats, share: PassShare, k: int) -> str:
    values = [
        (rows[0].task, value)
        for rows in repeats.values()
        if (value := share([row.has_succeeded for row in rows], k)) is not None
    ]
    found = clustered_mean(values)
    if found is None:
        return NONE
    bounds = found.interval
    if bounds is None:  # few tasks, or tasks that agree do not show how much others may differ
        tasks = len({task for task, _ in values})
        bounds = wilson(found.value * tasks, tasks)
    return f"{100 * found.value:.0f}% ({100 * bounds.low:.0f} to {100 * bounds.high:.0f})"


def _parting(results: Results, won: EpisodeRow, lost: EpisodeRow) -> tuple[str, str, str]:
    """Number of the first step that differs, and both actions; a run that has ended has none."""
    if not all(trace_file(results.folder, row.id).is_file() for row in (won, lost)):
        return NONE, NONE, NONE
    pairs = zip_longest(*(_actions(read_trace(results.folder, row.id)) for row in (won, lost)))
    for number, (winning, losing) in enumerate(pairs, 1):
        if winning != losing:
            return str(number), _words(winning), _words(losing)
    return NONE, "the same actions", "the same actions"


def _actions(trace: Sequence[Json]) -> Iterator[Json | None]:
    """Those of a trace, whose first step is the hand-over and whose last line the result; None for an answer that
    could not be read."""
    for line in trace[1:]:
        if "action" in line:
            yield line["action"]


def _words(action: Json | None) -> str:
    if action is None:
        return "none"
    fields = (str(value) for name, value in action.items() if name != "action_type")
    text = " ".join([str(action["action_type"]), *fields])
    return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
