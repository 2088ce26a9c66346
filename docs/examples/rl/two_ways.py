"""A game that rules do not solve: a short way over a narrow bridge, a long way round, and a fleet that learns.

    python docs/examples/rl/two_ways.py runs/two_ways 20

In the peak more cars set out than the bridge lets pass. Who goes by the news joins the queue until it costs as much
as the long way, and everybody behind waits too. Every car learns for itself: it sees the news and the time, chooses
a way or to drive slowly, and pays for the time that it needed and that it cost those behind it in the queue. All are measured on days
that nobody was trained on, beside rules with the same news, SUMO's device, and the equilibrium and optimum that
`scenarios equilibrate` finds. What has been learned and measured is kept in the folder; a second call goes on.
"""

import json
import sys
import time
from contextlib import closing
from functools import partial
from pathlib import Path

import numpy as np
from scipy.special import stdtrit

from automotive_cosim.contracts import Reroute, SlowDown
from automotive_cosim.studies.adoption.adoption import AdoptionJob, AdoptionPlan, drive, warmed_up
from automotive_cosim.studies.equilibrium.equilibrium import equilibrate
from automotive_cosim.studies.equilibrium.optimum import compare
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings
from automotive_cosim.studies.reroute.policies import parse_policy
from automotive_cosim.traffic import sumo_programs

FOLDER, MINUTES, DAYS = [*sys.argv[1:], *("runs/two_ways", 20, 20)[len(sys.argv) - 1 :]]
FOLDER = Path(FOLDER)
NODES = {"s": (-100, 0), "a": (0, 0), "b": (600, 0), "n": (1340, 0), "c": (1400, 0), "z": (1700, 0)}
NODES |= {"d": (700, 1000), "e": (1300, 1000)}
EDGES = {"start": "s a 2 13.89", "approach": "a b 2 13.89", "short": "b n 1 13.89", "bridge": "n c 1 4"}
EDGES |= {"out": "b d 1 13.89", "round": "d e 1 13.89", "back": "e c 1 13.89", "exit": "c z 2 13.89"}
SHORT = ("start", "approach", "short", "bridge", "exit")
LONG = ("start", "approach", "out", "round", "back", "exit")
PEAK = (0.15, 0.35, 0.5, 0.35, 0.15)  # cars a second, for five minutes each
ACTIONS = (None, Reroute(edges=LONG), SlowDown(30.0))
KNOTS_S = np.arange(60, 1560, 250)  # of the time of setting out, between which the policy is linear
UNSEEN, QUEUED_S, RATE = 1000, 10.0, 0.15  # first seed that is measured; delay of who queues; Adam's


def network():
    """Draws the ways and the demand, of which every seed is another day."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    nodes = [f'<node id="{name}" x="{x}" y="{y}"/>' for name, (x, y) in NODES.items()]
    form = '<edge id="{}" from="{}" to="{}" numLanes="{}" speed="{}"/>'
    edges = [form.format(name, *about.split()) for name, about in EDGES.items()]
    form = '<flow id="f{}" begin="{}" end="{}" probability="{}" departLane="best" departSpeed="max" route="r"/>'
    flows = [form.format(n, 60 + 300 * n, 360 + 300 * n, each) for n, each in enumerate(PEAK)]
    texts = {"nod": f"<nodes>{''.join(nodes)}</nodes>", "edg": f"<edges>{''.join(edges)}</edges>"}
    texts["rou"] = f'<routes><route id="r" edges="{" ".join(SHORT)}"/>{"".join(flows)}</routes>'
    for kind, text in texts.items():
        (FOLDER / f"two.{kind}.xml").write_text(text)
    made = ("-n", "two.nod.xml", "-e", "two.edg.xml", "-o", "two.net.xml", "--no-turnarounds", "true")
    assert sumo_programs.run("netconvert", made, FOLDER)[0]
    text = '<input><net-file value="two.net.xml"/><route-files value="two.rou.xml"/></input>'
    (FOLDER / "two.sumocfg").write_text(f"<configuration>{text}</configuration>")


def day(seed, assistant=None, every_s=3600.0, agent="never"):
    """A day with the assistant in every car: the trips by car, what was chosen, and how many failed."""
    plan = AdoptionPlan(str(FOLDER / "two.sumocfg"), agent=agent, warm_up_s=60.0, minutes=45.0, every_s=every_s)
    job = AdoptionJob(plan, seed)
    with closing(warmed_up(job)) as warm:
        said, trips = drive(job, warm, 1.0, assistant)
    assert not said.failed
    assert all(trip.has_left for trip in trips.values())
    return trips


def mean_s(trips):
    """Mean time of a trip, from when it was to begin."""
    return float(np.mean([trip.until_s - trip.planned_s for trip in trips.values()]))


class Rule:
    """A rule of `study reroute`, by the news as a car sets out."""

    def __init__(self, text):
        self.policy = parse_policy(text)

    def advise(self, car, state, ways):
        stay, *others = ways()
        other = next((way for way in others if "round" in way.edges), None)
        if other and self.policy.leaves(stay.eta_s, stay.delay_s, other.eta_s):
            return ACTIONS[1]
        return None


class Learner:
    """A softmax over the actions, linear in the news and piecewise linear in the time."""

    def __init__(self, seed=0, explores=False):
        self.rng, self.explores = np.random.default_rng(seed), explores
        self.weights = np.zeros((len(KNOTS_S) + 1, len(ACTIONS)))
        self.weights[:-1, 1:] -= 1.0, 4.0
        if (FOLDER / "learned.json").exists():
            self.weights = np.array(json.loads((FOLDER / "learned.json").read_text())["weights"])
        self.done = {}

    def advise(self, car, state, ways):
        times = {("round" in way.edges): way.eta_s for way in ways()}
        news = (times[False] - times.get(True, times[False])) / 120
        seen = np.append(np.interp(state.time_s, KNOTS_S, np.arange(len(KNOTS_S))), 0)[0]
        near = np.maximum(0, 1 - np.abs(np.arange(len(KNOTS_S)) - seen))
        seen = np.append(near, np.clip(news, -1, 3))
        powers = np.exp(seen @ self.weights - (seen @ self.weights).max())
        likely = powers / powers.sum()
        act = int(self.rng.choice(len(ACTIONS), p=likely))
        self.done[car] = seen, likely, act
        return ACTIONS[act]


def caused_s(arrived_s, took_s, on_bridge):
    """What each car cost those behind it: a gap of the bridge for everyone in the same queue."""
    cost = np.zeros(len(arrived_s))
    order = [car for car in np.argsort(arrived_s) if on_bridge[car]]
    free_s, behind, until_s = np.quantile(took_s[order], 0.02), 0, 0.0
    for car in reversed(order):
        if took_s[car] < free_s + QUEUED_S:  # the queue behind it is another
            behind = 0
        elif behind == 0:
            behind, until_s = 1, arrived_s[car]
        else:
            cost[car] = until_s - arrived_s[car]
    return cost


def train(minutes):
    """Policy gradient, a day at a time; a car pays for the time that it needed and that it cost those behind."""
    kept = FOLDER / "learned.json"
    learned = json.loads(kept.read_text()) if kept.exists() else {"days": 0, "curve": [], "minutes": 0.0}
    learner, began = Learner(len(learned["curve"]) + 1), time.monotonic()
    mean, square, usual = (np.array(learned.get(name, 0.0)) for name in ("mean", "square", "usual"))
    while (spent := (time.monotonic() - began) / 60) < minutes:
        learner.done = {}
        trips = day(learned["days"], learner)
        learned["days"] += 1
        cars = sorted(learner.done, key=lambda car: trips[car].planned_s)
        at_s = np.array([trips[car].planned_s for car in cars])
        took_s = np.array([trips[car].until_s for car in cars]) - at_s
        cost = took_s + caused_s(at_s + took_s, took_s, [learner.done[car][2] != 1 for car in cars])
        seen, likely, acts = map(np.array, zip(*(learner.done[car] for car in cars), strict=True))
        knots = seen[:, :-1].argmax(1)
        own = np.array([cost[knots == n].mean() if (knots == n).any() else 0.0 for n in range(len(KNOTS_S))])
        usual = own if not usual.shape else 0.8 * usual + 0.2 * own
        gain = usual[knots] - cost
        slope = seen.T @ ((np.eye(len(ACTIONS))[acts] - likely) * (gain / (gain.std() + 1e-6))[:, None]) / len(cars)
        mean, square = 0.8 * mean + 0.2 * slope, 0.97 * square + 0.03 * slope**2
        learner.weights += RATE * mean / (np.sqrt(square / (1 - 0.97 ** learned["days"])) + 1e-6)
        shares = np.bincount(acts, minlength=len(ACTIONS)) / len(acts)
        learned["curve"].append([learned["minutes"] + spent, float(took_s.mean()), *shares.tolist()])
        learned |= {name: value.tolist() for name, value in (("mean", mean), ("square", square), ("usual", usual))}
        kept.write_text(json.dumps(learned | {"weights": learner.weights.tolist()}))
        print(learned["days"], *(f"{value:.2f}" for value in learned["curve"][-1]), flush=True)
    learned["minutes"] += spent
    kept.write_text(json.dumps(learned | {"weights": learner.weights.tolist()}))


RULES = ("never", "always", "delay:0", "delay:30", "worthwhile:1:0", "worthwhile:1.2:60")
WAYS = {name: partial(day, assistant=Rule(name)) for name in RULES}
WAYS |= {"sumo": partial(day, every_s=30.0, agent="sumo"), "learners": lambda seed: day(seed, Learner(seed))}
STATES = ("equilibrium", "optimum")


def states(seed):
    """Mean times in the user equilibrium and the best known optimum of a day's trips."""
    options, folder = EquilibriumSettings(minutes=25, seed=seed, warm_up_s=60.0, steps=10), FOLDER / f"day{seed}"
    equilibrate(FOLDER / "two.sumocfg", folder, options, lambda step: None)
    found = compare(folder, FOLDER / f"day{seed}_optimum", options, (seed + 1, seed + 2), lambda step: None)
    return [np.mean([each.mean_s for each in state]) for state in (found.equilibrium, found.optimum)]


def measure(minutes):
    """Measures every rule and the learners on days that nobody was trained on, and the states of these days."""
    kept, began = FOLDER / "measured.json", time.monotonic()
    found = json.loads(kept.read_text()) if kept.exists() else {}
    for seed in range(UNSEEN, UNSEEN + int(DAYS)):
        row = found.setdefault(str(seed), {})
        for name, way in WAYS.items():
            if name not in row:
                row[name] = mean_s(way(seed))
        if STATES[0] not in row:
            row |= dict(zip(STATES, states(seed), strict=True))
        kept.write_text(json.dumps(found))
        if (time.monotonic() - began) / 60 > minutes:
            break
    return [row for row in found.values() if STATES[0] in row]


def interval(values):
    """Mean and 95 % t interval."""
    reach = stdtrit(len(values) - 1, 0.975) * np.std(values, ddof=1) / len(values) ** 0.5
    return f"{np.mean(values):.2f} ({np.mean(values) - reach:.2f} to {np.mean(values) + reach:.2f})"


def tell(rows):
    """The table: mean times, and as a ratio to the optimum of the same day."""
    for name in rows[0]:
        ratios = [row[name] / row["optimum"] for row in rows]
        print(f"| {name} | {np.mean([row[name] for row in rows]):.1f} | {interval(ratios)} |")
    best = min(RULES, key=lambda name: np.mean([row[name] for row in rows]))
    gains = [row[best] - row["learners"] for row in rows]
    print(f"learners arrive sooner than {best}, the best rule, by s: {interval(gains)}, {len(rows)} days")


if __name__ == "__main__":
    network()
    train(float(MINUTES))
    tell(measure(float(MINUTES)))
