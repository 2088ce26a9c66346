"""A game that rules do not solve: a narrow bridge far ahead, a long way round, and a fleet that learns.

    python docs/examples/rl/two_ways.py runs/two_ways

In a short peak more cars set out than the bridge lets pass. Where a car chooses, the queue is minutes ahead:
the news tells of the cars that left minutes ago, so all who go by it choose alike, too late and for too long.
Every group of cars, by the time of setting out, learns for itself: it draws a way, or a slow drive, and pays
for the time that it needed and for the time that it cost those behind. All are measured on days that nobody was
trained on, beside rules with the news, SUMO's device, and the equilibrium and optimum that `scenarios
equilibrate` finds. What has been learned and measured stays in the folder, and a second call goes on.
"""

import json
import sys
import time
from contextlib import closing, contextmanager
from itertools import zip_longest
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from scipy.special import stdtrit

from automotive_cosim.contracts import Reroute, SlowDown
from automotive_cosim.run.road import read_road
from automotive_cosim.studies.adoption.adoption import AdoptionPlan, drive, warmed_up
from automotive_cosim.studies.calls.chosen import day, prepare
from automotive_cosim.studies.equilibrium.equilibrium import equilibrate
from automotive_cosim.studies.equilibrium.optimum import compare
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.fork import Forked

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/two_ways")
LEARNED, MEASURED = FOLDER / "learned.json", FOLDER / "measured.json"
TRAINED, TESTED = range(24), range(1000, 1010)  # seeds; each is another day's demand
PASSES, DAYS, RATE = 3, 4, 0.5  # how often each day is learned from, how often in a row, and how fast
NODES = {"s": (-600, 0), "a": (0, 0), "n": (2500, 0), "c": (2560, 0), "z": (2760, 0), "d": (600, 900)}
NODES |= {"e": (2500, 900)}
EDGES = {"start": "s a 2 13.89", "short": "a n 1 13.89", "bridge": "n c 1 4", "out": "a d 1 13.89"}
EDGES |= {"round": "d e 1 13.89", "back": "e c 1 13.89", "exit": "c z 2 13.89"}
SHORT, LONG = ("start", "short", "bridge", "exit"), ("start", "out", "round", "back", "exit")
PEAK = (0.15, 0.3, 0.5, 0.5, 0.3, 0.15)  # cars a second, for two minutes each
SPAN_S, GROUP_S, SECONDS = 120, 40, 2400.0
WARM_UP_S = 10.0
ACTIONS = (None, Reroute(edges=LONG), SlowDown(30.0))
GROUPS = SPAN_S * len(PEAK) // GROUP_S
RULES = ("never", "always", "delay:0", "delay:30", "worthwhile:1:0", "worthwhile:1.2:60", "sumo")
STATES = ("equilibrium", "optimum")


def network():
    """Draws the ways and the demand, of which every seed is another day."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    nodes = [f'<node id="{name}" x="{x}" y="{y}"/>' for name, (x, y) in NODES.items()]
    form = '<edge id="{}" from="{}" to="{}" numLanes="{}" speed="{}"/>'
    edges = [form.format(name, *about.split()) for name, about in EDGES.items()]
    form = '<flow id="f{}" begin="{}" end="{}" probability="{}" departLane="best" departSpeed="max" route="r"/>'
    flows = [
        form.format(n, WARM_UP_S + SPAN_S * n, WARM_UP_S + SPAN_S * (n + 1), each) for n, each in enumerate(PEAK)
    ]
    texts = {"nod": f"<nodes>{''.join(nodes)}</nodes>", "edg": f"<edges>{''.join(edges)}</edges>"}
    texts["rou"] = f'<routes><route id="r" edges="{" ".join(SHORT)}"/>{"".join(flows)}</routes>'
    for kind, text in texts.items():
        (FOLDER / f"two.{kind}.xml").write_text(text)
    made = ("-n", "two.nod.xml", "-e", "two.edg.xml", "-o", "two.net.xml", "--no-turnarounds", "true")
    assert sumo_programs.run("netconvert", made, FOLDER)[0]
    text = '<input><net-file value="two.net.xml"/><route-files value="two.rou.xml"/></input>'
    (FOLDER / "two.sumocfg").write_text(f"<configuration>{text}</configuration>")


def plan(seed=0, agent="never"):
    """The traffic, as `study adoption` drives it."""
    return AdoptionPlan(
        str(FOLDER / "two.sumocfg"),
        seeds=(seed,),
        agent=agent,
        warm_up_s=WARM_UP_S,
        minutes=SECONDS / 60,
        every_s=30.0,
        driver="steady",
    )


@contextmanager
def warm(seed):
    """The traffic of a seed, of which any number of days are copies."""
    with closing(Forked(plan().scene(), seed, allow_unprojected=True)) as made:
        made.call(prepare)
        yield made


def mean_s(trips):
    """Mean time of a trip, from when it was to begin; nobody is left on the road."""
    assert all(getattr(trip, "has_arrived", True) and getattr(trip, "has_left", True) for trip in trips.values())
    return float(np.mean([trip.until_s - trip.planned_s for trip in trips.values()]))


class Learners:
    """For every group of cars, the odds of each action."""

    def __init__(self):
        self.logits = np.zeros((GROUPS, len(ACTIONS)))
        self.usual_s = np.full(GROUPS, np.nan)  # what a car of the group costs, as it is used to

    def odds(self):
        powers = np.exp(self.logits - self.logits.max(1, keepdims=True))
        return powers / powers.sum(1, keepdims=True)

    def choose(self, planned_s, rng):
        """Of each car, the number of its group and of its action."""
        groups = {car: min(GROUPS - 1, int((at_s - WARM_UP_S) // GROUP_S)) for car, at_s in planned_s.items()}
        odds = self.odds()
        return {car: (group, int(rng.choice(len(ACTIONS), p=odds[group]))) for car, group in groups.items()}

    def learn(self, chosen, cost_s):
        """Policy gradient: what cost less than usual becomes likelier."""
        odds, slope = self.odds(), np.zeros_like(self.logits)
        for group in range(GROUPS):
            cars = [(act, cost_s[car]) for car, (its, act) in chosen.items() if its == group]
            if len(cars) < 2:
                continue
            acts, costs = np.array([act for act, _ in cars]), np.array([cost for _, cost in cars])
            if np.isnan(self.usual_s[group]):
                self.usual_s[group] = costs.mean()
            gain = (self.usual_s[group] - costs) / 60
            slope[group] = (gain[:, None] * (np.eye(len(ACTIONS))[acts] - odds[group])).mean(0)
            self.usual_s[group] += 0.1 * (costs.mean() - self.usual_s[group])
        self.logits = np.clip(self.logits + RATE * slope, -4, 4)


def driven(made, planned_s, chosen):
    """A day on which every car does what was chosen for it."""
    asked = {car: ACTIONS[act] for car, (_, act) in chosen.items() if ACTIONS[act] is not None}
    trips = day(made, asked, SECONDS)
    assert trips.keys() == planned_s.keys()
    return trips


def cost_of(trips, chosen):
    """What a trip cost all: its time, and, over the bridge, the time from its passing to the end of the queue.

    That is what all behind wait for it together."""
    cost = {car: trip.until_s - trip.planned_s for car, trip in trips.items()}
    over = sorted((trips[car].until_s, car) for car, (_, act) in chosen.items() if act != 1)
    free_s = min(cost[car] for _, car in over) if over else 0.0
    end_s = 0.0
    for at_s, car in reversed(over):
        if trips[car].until_s - trips[car].planned_s < free_s + 10 + 120 * (chosen[car][1] == 2):
            end_s = at_s  # whoever does not wait has nobody's queue before him
        else:
            cost[car] += max(0.0, end_s - at_s)
    return cost


def train():
    """Days in turn until each has been learned from so often; a second call goes on."""
    kept = json.loads(LEARNED.read_text()) if LEARNED.exists() else {"done": 0, "curve": [], "seconds": 0.0}
    learners, curve, seconds = Learners(), kept["curve"], kept["seconds"]
    if curve:
        learners.logits, learners.usual_s = np.array(kept["logits"]), np.array(kept["usual_s"])
    for number in range(kept["done"], PASSES * len(TRAINED)):
        rng, began_s = np.random.default_rng(number), time.monotonic()
        with warm(TRAINED[number % len(TRAINED)]) as made:
            planned_s = {car: trip.planned_s for car, trip in day(made, {}, SECONDS).items()}
            for _ in range(DAYS):
                chosen = learners.choose(planned_s, rng)
                trips = driven(made, planned_s, chosen)
                learners.learn(chosen, cost_of(trips, chosen))
                curve.append([mean_s(trips), *learners.odds().mean(0).tolist()])
        seconds += time.monotonic() - began_s
        kept = {"done": number + 1, "logits": learners.logits.tolist(), "usual_s": learners.usual_s.tolist()}
        LEARNED.write_text(json.dumps(kept | {"curve": curve, "seconds": seconds}))
        print(number, f"{seconds / 60:.1f} min", *(f"{value:.2f}" for value in curve[-1]), flush=True)


class Learned:
    """The learners after all their days, as an assistant of `study adoption`."""

    def __init__(self, seed):
        self.rng, self.learners = np.random.default_rng(seed), Learners()
        self.learners.logits = np.array(json.loads(LEARNED.read_text())["logits"])
        self.asked = set()

    def advise(self, car, state, ways):
        """Draws once, as the car sets out."""
        if car in self.asked:
            return None
        self.asked.add(car)
        return ACTIONS[self.learners.choose({car: state.time_s}, self.rng)[car][1]]


def studied(seed, rule, keeps=None):
    """A day on which every car has the learners or a rule with the news, or SUMO's device, as its assistant."""
    (job,) = plan(seed, "never" if rule == "learners" else rule).jobs()
    with closing(warmed_up(job)) as made:
        assistant = Learned(seed) if rule == "learners" else None
        said, trips = drive(job, made, 1.0, assistant, keeps=keeps)
    assert not said.errors
    return trips


def states(seed):
    """Mean times in the user equilibrium and the best known optimum of a day's trips."""
    options, folder = (
        EquilibriumSettings(minutes=13, seed=seed, warm_up_s=WARM_UP_S, steps=10),
        FOLDER / f"day{seed}",
    )
    if not folder.exists():
        equilibrate(FOLDER / "two.sumocfg", folder, options, lambda step: None)
    target = FOLDER / f"day{seed}_optimum"
    found = compare(folder, target, options, (seed + 1, seed + 2), lambda step: None)
    return [float(np.mean([each.mean_s for each in state])) for state in (found.equilibrium, found.optimum)]


def measure():
    """Every rule, the learners and the states of each day that nobody was trained on."""
    found = json.loads(MEASURED.read_text()) if MEASURED.exists() else {}
    for seed in TESTED:
        row = found.setdefault(str(seed), {})
        for rule in (*RULES, "learners"):
            row[rule] = row.get(rule) or mean_s(studied(seed, rule))
        if STATES[0] not in row:
            row |= dict(zip(STATES, states(seed), strict=True))
        MEASURED.write_text(json.dumps(found))
        print(seed, *(f"{name} {value:.0f}" for name, value in row.items()), flush=True)
    return [found[str(seed)] for seed in TESTED]


def interval(values):
    """Mean and 95 % t interval."""
    reach = stdtrit(len(values) - 1, 0.975) * np.std(values, ddof=1) / len(values) ** 0.5
    return f"{np.mean(values):.2f} ({np.mean(values) - reach:.2f} to {np.mean(values) + reach:.2f})"


def tell(rows):
    """A table of mean times, and by how much sooner the learners arrive than each."""
    print("| | trip, s | later than the learners, s |\n|---|--:|--:|")
    for name in rows[0]:
        later = "" if name == "learners" else interval([row[name] - row["learners"] for row in rows])
        print(f"| {name} | {np.mean([row[name] for row in rows]):.0f} | {later} |")
    for name in (STATES[0], "learners"):
        print(f"{name} by optimum: {interval([row[name] / row[STATES[1]] for row in rows])}, {len(rows)} days")
    return min(RULES, key=lambda name: np.mean([row[name] for row in rows]))


def place(side, x_m, y_m):
    """Where on a page of the film."""
    return 30 + 620 * side + (x_m + 600) / 6, 220 - y_m / 6


def film(rule):
    """The best rule and the learners side by side on the same day, and the curve of learning."""
    seen = []
    for name in (rule, "learners"):
        studied(TESTED[0], name, FOLDER / name.partition(":")[0])
        (path,) = (FOLDER / name.partition(":")[0]).glob("live/*/road.jsonl.gz")
        seen.append([line["seen"] for line in read_road(path) if "seen" in line][::10])
    pages = []
    for number, cars in enumerate(zip_longest(*seen, fillvalue=[])):
        pages.append(page := Image.new("RGB", (1260, 250), "white"))
        draw = ImageDraw.Draw(page)
        for side, (name, each) in enumerate(zip((rule, "learners"), cars, strict=True)):
            for about in EDGES.values():
                draw.line([place(side, *NODES[node]) for node in about.split()[:2]], "lightgray", 5)
            for _, x_m, y_m, *_ in each:
                x, y = place(side, x_m + NODES["s"][0], y_m)  # netconvert begins at 0
                draw.ellipse((x - 3, y - 3, x + 3, y + 3), "darkblue")
            draw.text(
                (30 + 620 * side, 8), f"{name}: {len(each)} cars, {number / 6:.0f} min", "black", font_size=20
            )
    pages[0].save(FOLDER / "film.webp", save_all=True, append_images=pages[1:], duration=80, quality=60)
    curve = [row[0] for row in json.loads(LEARNED.read_text())["curve"]]
    wide, top = max(2, len(curve)), max(curve)
    draw = ImageDraw.Draw(page := Image.new("RGB", (900, 420), "white"))
    for value in range(0, int(top), 100):
        draw.line([(60, 390 - 340 * value / top), (880, 390 - 340 * value / top)], "lightgray", 1)
        draw.text((8, 380 - 340 * value / top), f"{value} s", "black", font_size=16)
    draw.line([(60 + 820 * n / wide, 390 - 340 * each / top) for n, each in enumerate(curve)], "darkblue", 2)
    draw.text((60, 8), f"mean trip on each of {len(curve)} days of learning", "black", font_size=20)
    page.save(FOLDER / "curve.png")


if __name__ == "__main__":
    network()
    train()
    film(tell(measure()))
