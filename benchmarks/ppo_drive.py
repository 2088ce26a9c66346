"""Imitation and PPO learn to watch over drives; their scores on unseen seeds and on an unseen network.

    pip install 'automotive-cosim[rl]' matplotlib
    python benchmarks/ppo_drive.py --out docs/images --film
    python benchmarks/ppo_drive.py --film docs/images/ppo_drive_imitation.npz      # only the film

Without a GPU, install torch first, in its CPU build. The policy is a network of two small layers over the numbers
of ``FlatDriveEnv``: two waits and one action per kind of alert. "imitation" first learns what the rule-perfect
watcher would do, on the watcher's drives and on those of the policy as it is by then (DAgger: Ross et al. 2011),
then PPO goes on; "few drives" does so after a fifth of the watcher's drives; "scratch" is PPO alone, to which a
nuisance at first costs a share of what the judge takes. Scores are the judge's in all figures: 0 for silence, 100
for the rule-perfect watcher. Training drives have seeds below 1000, those of measurement 1000 and up; the network
of ``--unseen`` is never trained on.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from copy import deepcopy
from dataclasses import dataclass, field
from functools import partial
from itertools import accumulate, product
from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from automotive_cosim.contracts import AlertKind
from automotive_cosim.drives.score import LEAST_WORTH, Score, score, together
from automotive_cosim.drives.watchers import AlertOnWake, RulePerfect
from automotive_cosim.envs.flat_drive import ACTIONS, FEATURES, SLOTS, SOON, FlatDriveEnv

FAMILIES = ("grid_june", "beauce_june", "alpine_july")
UNSEEN = "nordic_july"
FIRST_UNSEEN = 1000
LAYERS = (256, 128)
FEWER = 5
"""Of the watcher's drives, one in so many is imitated from few drives."""
GIVEN = 0.3
"""The share of its alerts that a watcher gives which shows what to do; so it also shows what to do when late."""
FORGOTTEN = 0.5
"""How often an imitation sees no words in training, lest it knows the countries by them."""
SPREAD = 0.25
"""Least standard deviation of a number that is standardised."""
RESAMPLES = 2000
"""Of the drives, for an interval that holds the score of 95 % of them."""
SHY = 4.0
"""An untrained policy prefers waits to alerts by this logit: otherwise nine of ten acts are alerts, nearly all of
them cost, and it learns silence before it learns anything else."""
GAMMA = 0.97
CHEAP = {"scratch": 0.05, "few drives": 1.0, "imitation": 1.0}
"""The share of a nuisance's cost at the beginning of training, by what it starts from. It rises to the whole cost
by two thirds of the steps: whoever knows nothing yet and pays in full learns silence."""
BEFORE, AFTER, FRAME_MS = 2, 3, 700
"""Steps that a film shows before and after an alert, and how long each."""
WORDS = slice(len(FEATURES), len(FEATURES) + sum(SLOTS))
"""Where an observation has words."""
WAITS = sum(action.kind is None for action in ACTIONS)


# --- policies ----------------------------------------------------------------------------------------------------


class Random:
    def reset(self) -> None:
        self._rng = np.random.default_rng(0)

    def act(self, env: FlatDriveEnv, seen: np.ndarray) -> int:
        return int(self._rng.integers(len(ACTIONS)))


class Silent:
    def reset(self) -> None: ...

    def act(self, env: FlatDriveEnv, seen: np.ndarray) -> int:
        return 0


@dataclass
class Watcher:
    """A watcher that reads the observation itself, through the flat actions."""

    made: Callable[[], RulePerfect | AlertOnWake]

    def reset(self) -> None:
        self._watcher = self.made()

    def act(self, env: FlatDriveEnv, seen: np.ndarray) -> int:
        number = env.number(self._watcher.act(env.episode.observation))
        return SOON if number is None else number


TABLE: tuple[tuple[AlertKind, tuple[tuple[str, float, float], ...]], ...] = (
    (AlertKind.COLLISION, (("braking that it asks for", 0.68, 1.0),)),
    (AlertKind.YIELD, (("blue light behind", 0.01, 0.5),)),
    (AlertKind.SPEED, (("slowing that it asks for", 0.4, 1.0), ("speed", 0.16, 1.0))),
    (AlertKind.SPEED, (("just above the limit", 0.51, 1.0), ("speed", 0.16, 1.0))),
    (AlertKind.DISTANCE, (("shortness of the gap", 0.01, 1.0), ("speed", 0.23, 1.0))),
    (AlertKind.TRAFFIC, (("nearness of a jam", 0.5, 1.0), ("speed", 0.31, 1.0))),
    (AlertKind.TRAFFIC, (("nearness of a roadworks", 0.6, 1.0), ("speed", 0.14, 1.0))),
    (AlertKind.MOVE_OVER, (("nearness of a breakdown", 0.6, 1.0), ("speed", 0.14, 1.0))),
    (AlertKind.TUNNEL, (("nearness of a tunnel", 0.66, 1.0), ("low beam", 0.0, 0.0))),
    (AlertKind.VISIBILITY, (("unwiped", 0.4, 1.0),)),
    (AlertKind.VISIBILITY, (("in a tunnel", 1.0, 1.0), ("low beam", 0.0, 0.0))),
    (AlertKind.VISIBILITY, (("speed for the sight", 0.5, 1.0),)),
    (AlertKind.VISIBILITY, (("fogged", 0.4, 1.0),)),
    (AlertKind.SLIPPERY, (("slipperiness", 0.5, 1.0), ("speed", 0.31, 1.0))),
    (AlertKind.SEAT_BELT, (("people not belted", 0.1, 1.0), ("speed", 0.19, 1.0))),
    (AlertKind.DISTRACTION, (("phone in the hand", 1.0, 1.0), ("speed", 0.16, 1.0))),
    (AlertKind.VEHICLE, (("open trunk or charging flap", 1.0, 1.0), ("speed", 0.04, 1.0))),
    (AlertKind.VEHICLE, (("softest tyre", 0.51, 1.0),)),
    (AlertKind.VEHICLE, (("shortness of the range", 0.8, 1.0),)),
    (AlertKind.VEHICLE, (("driver has left", 1.0, 1.0), ("who needs care", 0.1, 1.0), ("adults", 0.0, 0.0))),
    (AlertKind.FATIGUE, (("driving time", 0.5, 1.0),)),
)
"""What an engineer would write down: an alert is shown while numbers of the present instant lie in these ranges."""
JUST = 0.65
"""An alert that was shown a minute ago has this age; the table does not show it again before."""


ONE_EACH = tuple(
    (alert, ranges[:1]) for at, (alert, ranges) in enumerate(TABLE) if alert not in {row[0] for row in TABLE[:at]}
)
"""What one would write down first: the most frequent reason for each alert, one number and one threshold."""


@dataclass
class Table:
    """A table of thresholds, the most urgent rows first."""

    rows: tuple[tuple[AlertKind, tuple[tuple[str, float, float], ...]], ...]

    def reset(self) -> None: ...

    def act(self, env: FlatDriveEnv, seen: np.ndarray) -> int:
        now = dict(zip(FEATURES, seen, strict=False))
        ages = dict(zip(AlertKind, seen[-len(AlertKind) :], strict=True))
        for alert, ranges in self.rows:
            if ages[alert] > JUST and all(low <= now[name] <= high for name, low, high in ranges):
                return WAITS + list(AlertKind).index(alert)
        return SOON


@dataclass
class Network:
    """A trained policy: weights and biases of its layers. It takes the action with the highest logit."""

    layers: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    def reset(self) -> None: ...

    def act(self, env: FlatDriveEnv, seen: np.ndarray) -> int:
        for number, (weights, biases) in enumerate(self.layers):
            seen = weights @ (np.tanh(seen) if number else seen) + biases
        return int(np.argmax(seen))

    @classmethod
    def read(cls, path: Path) -> Network:
        arrays = np.load(path)
        return cls([(arrays[f"weights{at}"], arrays[f"biases{at}"]) for at in range(len(arrays) // 2)])

    def write(self, path: Path) -> None:
        np.savez_compressed(path, **{
            f"{kind}{at}": each for at, pair in enumerate(self.layers)
            for kind, each in zip(("weights", "biases"), pair, strict=True)
        })  # fmt: skip

    @classmethod
    def of(cls, model) -> Network:
        linear = [*model.policy.mlp_extractor.policy_net, model.policy.action_net]
        return cls([
            (each.weight.detach().numpy().copy(), each.bias.detach().numpy().copy())
            for each in linear
            if hasattr(each, "weight")
        ])._over(*model.policy.features_extractor.scale())  # fmt: skip

    def _over(self, mean: np.ndarray, deviation: np.ndarray) -> Network:
        """The same network over numbers that are not standardised."""
        (weights, biases), *others = self.layers
        return Network([(weights / deviation, biases - weights @ (mean / deviation)), *others])


BASELINES = {
    "random": Random(),
    "silent": Silent(),
    "alert on wake": Watcher(AlertOnWake),
    "rules": Watcher(RulePerfect),
    "a row per alert": Table(ONE_EACH),
    "table": Table(TABLE),
}


@dataclass
class Driven:
    """What a policy did on one drive."""

    score: Score
    kinds: dict[str, tuple[int, int]]
    """Events met and missed by kind."""


def one(task: tuple, minutes: float) -> Driven:
    """One drive of measurement."""
    policy, family, seed = task
    with closing(FlatDriveEnv(family, minutes=minutes)) as env:
        seen, _ = env.reset(seed=seed)
        policy.reset()
        over = False
        while not over:
            seen, _, terminated, truncated, _ = env.step(np.int64(policy.act(env, seen)))
            over = terminated or truncated
        judged = env.episode.judgement
        kinds = {
            kind: (
                sum(event.outcome.is_credited for event in judged.events if event.kind == kind),
                sum(event.outcome.counts for event in judged.events if event.kind == kind),
            )
            for kind in {event.kind for event in judged.events if event.outcome.counts}
        }
        return Driven(score(judged, env.episode.seconds), kinds)


@dataclass
class Lessons:
    """Steps of drives: what was seen, what the rule-perfect watcher would do, and what came of what was done."""

    seen: np.ndarray
    wanted: np.ndarray
    returns: np.ndarray
    """Discounted rewards from here on."""

    @classmethod
    def read(cls, path: Path) -> Lessons:
        return cls(**np.load(path))

    def write(self, path: Path) -> None:
        np.savez_compressed(path, seen=self.seen, wanted=self.wanted, returns=self.returns)

    @classmethod
    def joined(cls, parts: Sequence[Lessons]) -> Lessons:
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__dataclass_fields__))


def taught(task: tuple, minutes: float) -> Lessons:
    """A drive of a policy, or of a watcher that leaves out some of its alerts, with what the watcher would do."""
    policy, family, seed = task
    watcher, drawn = RulePerfect(), np.random.default_rng(seed)
    seens, wanted, rewards = [], [], []
    with closing(FlatDriveEnv(family, minutes=minutes)) as env:
        seen, _ = env.reset(seed=seed)
        over = False
        while not over:
            now = env.episode.observation
            before = deepcopy(watcher)
            number = env.number(watcher.act(now))
            right = SOON if number is None else number
            if policy is not None:
                done = policy.act(env, seen)
            else:
                done = SOON if right >= WAITS and drawn.random() > GIVEN else right
            if done != right:
                watcher = before
                watcher.look_on(now, ACTIONS[done])
            seens.append(seen)
            wanted.append(right)
            seen, reward, terminated, truncated, _ = env.step(np.int64(done))
            rewards.append(lenient(reward, 1.0))
            over = terminated or truncated
    returns = list(accumulate(reversed(rewards), lambda later, reward: reward + GAMMA * later))[::-1]
    return Lessons(np.stack(seens), np.array(wanted), np.array(returns, np.float32))


class Bench:
    """Measures policies and teaches them, in several processes."""

    def __init__(self, chosen: argparse.Namespace) -> None:
        self._chosen = chosen
        self._pool = ProcessPoolExecutor(chosen.workers, multiprocessing.get_context("forkserver"))
        self._tables: dict[str, list[Driven]] = {}

    def measured(self, policy, drives: int) -> dict:
        """Scores on unseen seeds of the families, and on the unseen network; what a policy did."""
        given = self._chosen
        seeds = range(FIRST_UNSEEN, FIRST_UNSEEN + drives)
        tasks = [(policy, family, seed) for family, seed in product((*given.families, given.unseen), seeds)]
        found = list(self._pool.map(partial(one, minutes=given.minutes), tasks))
        seen, unseen = ([each.score for each in part] for part in (found[:-drives], found[-drives:]))
        counts: dict[str, list[int]] = {}
        for kind, (met, events) in (item for each in found for item in each.kinds.items()):
            before = counts.get(kind, [0, 0])
            counts[kind] = [before[0] + met, before[1] + events]
        point = {
            "score": together(seen).value,
            "score_between": between(seen),
            "unseen_network": together(unseen).value,
            "unseen_network_between": between(unseen),
            "drives": [len(seen), len(unseen)],
            "events": [together(part).events for part in (seen, unseen)],
            "met": [together(part).met for part in (seen, unseen)],
            "nuisances": [together(part).nuisances for part in (seen, unseen)],
            "kinds": dict(sorted(counts.items())),
        }
        for name, others in self._tables.items():
            table = [each.score for each in others]
            point[f"above_{name}_between"] = [
                between(seen, table[:-drives]), between(unseen, table[-drives:])
            ]  # fmt: skip
        if isinstance(policy, Table):
            self._tables[f"table_of_{len(policy.rows)}"] = found
        return point

    def lessons(self, policy, first: int, drives: int) -> Lessons:
        """Steps on training drives of a policy, or of the watcher without one."""
        given = self._chosen
        tasks = [(policy, family, seed) for seed, family in product(range(first, first + drives), given.families)]
        return Lessons.joined(list(self._pool.map(partial(taught, minutes=given.minutes), tasks)))

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


def between(scores: Sequence[Score], others: Sequence[Score] = ()) -> list[float]:
    """Between which values 95 % of the scores lie that drives drawn from these have together; of their differences
    from those that others have on the same drives."""
    drawn = np.random.default_rng(0).integers(len(scores), size=(RESAMPLES, len(scores)))

    def values(found: Sequence[Score]) -> np.ndarray:
        utility, worth = (np.array([getattr(each, name) for each in found]) for name in ("utility", "worth"))
        total = worth[drawn].sum(1)
        return 50 * utility[drawn].sum(1) / np.where(total > 0, total, LEAST_WORTH * len(found))

    found = values(scores) - (values(others) if others else 0.0)
    return [float(value) for value in np.percentile(found, (2.5, 97.5))]


# --- training ----------------------------------------------------------------------------------------------------


class Lenient(gym.RewardWrapper):
    """Training drives, with rewards in weights of events; a nuisance costs a share of what the judge takes."""

    share = 1.0

    def charge(self, share: float) -> None:
        self.share = share

    def reset(self, *, seed=None, options=None):
        if seed is not None:
            self._drawn = np.random.default_rng(seed)
        return self.env.reset(seed=int(self._drawn.integers(FIRST_UNSEEN)))

    def reward(self, reward: float) -> float:
        return lenient(reward, self.share)


def lenient(reward: float, share: float) -> float:
    return LEAST_WORTH * (reward if reward > 0 else share * reward)


def made_env(families: Sequence[str], minutes: float) -> gym.Env:
    return Lenient(FlatDriveEnv(families, minutes=minutes))


def learner(chosen: argparse.Namespace, start: str):
    """PPO, untrained."""
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.torch_layers import FlattenExtractor
    from stable_baselines3.common.vec_env import SubprocVecEnv

    class Standard(FlattenExtractor):
        """Numbers with the mean and the deviation of those that are imitated."""

        def __init__(self, space: gym.Space) -> None:
            super().__init__(space)
            self.register_buffer("mean", torch.zeros(space.shape))
            self.register_buffer("deviation", torch.ones(space.shape))

        def forward(self, seen: torch.Tensor) -> torch.Tensor:
            return (super().forward(seen) - self.mean) / self.deviation

        def standardise(self, seen: torch.Tensor) -> None:
            self.mean, self.deviation = seen.mean(0), seen.std(0).clamp(min=SPREAD)
            self.mean[WORDS], self.deviation[WORDS] = 0.0, 1.0

        def scale(self) -> tuple[np.ndarray, np.ndarray]:
            return self.mean.numpy(), self.deviation.numpy()

    torch.set_num_threads(1)
    envs = make_vec_env(
        partial(made_env, chosen.families, chosen.minutes), n_envs=chosen.workers, seed=chosen.seed,
        vec_env_cls=SubprocVecEnv, vec_env_kwargs={"start_method": "forkserver"},
    )  # fmt: skip
    warm = start != "scratch"
    model = PPO(
        "MlpPolicy", envs, n_steps=min(1024, chosen.steps // chosen.rounds) // chosen.workers, batch_size=128,
        n_epochs=6, gamma=GAMMA,
        learning_rate=1e-4 if warm else 3e-4, ent_coef=0.0 if warm else 0.01, clip_range=0.1 if warm else 0.2,
        target_kl=0.02 if warm else None, seed=chosen.seed, device="cpu",
        policy_kwargs={"net_arch": list(LAYERS), "features_extractor_class": Standard},
    )  # fmt: skip
    if not warm:
        with torch.no_grad():
            model.policy.action_net.bias[WAITS:] -= SHY
    return model


def charges(first: float, full_at: float):
    """Raises the share of a nuisance's cost from the first one to 1, by a constant factor per step of training."""
    from stable_baselines3.common.callbacks import BaseCallback

    class Charges(BaseCallback):
        def _on_rollout_start(self) -> None:
            self.training_env.env_method("charge", min(1.0, first ** (1 - self.num_timesteps / full_at)))

        def _on_step(self) -> bool:
            return True

    return Charges()


def imitate(model, lessons: Lessons, own: Lessons | None, epochs: int) -> None:
    """Fits the policy to what the watcher would do, and the value to what the policy earned on its own drives.

    Alerts count more, as there is one to forty waits."""
    import torch

    seen, wanted = torch.as_tensor(lessons.seen), torch.as_tensor(lessons.wanted)
    model.policy.features_extractor.standardise(seen)
    weights = torch.where(wanted < WAITS, 1.0, 4.0)
    drawn = torch.Generator().manual_seed(0)

    def policy_off(batch):
        looks = seen[batch]
        looks[torch.rand(len(batch), generator=drawn) < FORGOTTEN, WORDS] = 0.0
        _, logs, _ = model.policy.evaluate_actions(looks, wanted[batch])
        return -(weights[batch] * logs).mean()

    _fit(model, policy_off, len(seen), epochs, drawn)
    if own is not None:
        looks, worth = torch.as_tensor(own.seen), torch.as_tensor(own.returns)
        fitted = model.policy.value_net, model.policy.mlp_extractor.value_net

        def value_off(batch):
            return (model.policy.predict_values(looks[batch])[:, 0] - worth[batch]).square().mean()

        _fit(model, value_off, len(looks), epochs, drawn, fitted)


def _fit(model, off, count: int, epochs: int, drawn, modules=None) -> None:
    """Lowers what is off, over batches of some numbers of steps."""
    import torch

    fitted = [each for module in modules or [model.policy] for each in module.parameters()]
    optimizer = torch.optim.AdamW(fitted, lr=2e-3, weight_decay=0.01)
    falling = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, epochs)
    for _ in range(epochs):
        for batch in torch.randperm(count, generator=drawn).split(256):
            optimizer.zero_grad()
            off(batch).backward()
            optimizer.step()
        falling.step()


def schooled(chosen: argparse.Namespace, model, bench: Bench) -> None:
    """Imitates the watcher on its own drives, then also on those that the policy so far drives (DAgger)."""
    own = None
    if chosen.lessons and chosen.lessons.exists():
        lessons = Lessons.read(chosen.lessons)
    else:
        lessons = bench.lessons(None, 0, chosen.demonstrations)
        if chosen.lessons:
            lessons.write(chosen.lessons)
    imitate(model, lessons, own, chosen.epochs)
    for number in range(chosen.corrections):
        first = chosen.demonstrations + number * chosen.corrected
        own = bench.lessons(Network.of(model), first, chosen.corrected)
        lessons = Lessons.joined([lessons, own])
        imitate(model, lessons, own, chosen.epochs)


def train(chosen: argparse.Namespace, start: str, bench: Bench) -> Iterator[tuple[dict, Network]]:
    """The learning curve: steps, scores and seconds, each with the policy."""
    model = learner(chosen, start)
    if start == "few drives":
        imitate(model, bench.lessons(None, 0, max(1, chosen.demonstrations // FEWER)), None, 2 * chosen.epochs)
    if start == "imitation":
        schooled(chosen, model, bench)
    charging = charges(CHEAP[start], chosen.steps * 2 / 3)
    trained_s = 0.0
    for number in range(chosen.rounds + 1):
        if number:
            began_s = time.monotonic()
            model.learn(chosen.steps // chosen.rounds, charging, reset_num_timesteps=False)
            trained_s += time.monotonic() - began_s
        policy = Network.of(model)
        point = {"steps": model.num_timesteps, "seconds": trained_s, **bench.measured(policy, chosen.drives)}
        print(f"{start:>9}  {point['steps']:7.0f} steps  {told(point)}  {trained_s:5.0f} s", flush=True)
        yield point, policy
    model.get_env().close()


def told(point: dict) -> str:
    scores = (
        f"{where} {point[key]:7.1f} ({point[f'{key}_between'][0]:.0f} to {point[f'{key}_between'][1]:.0f})"
        for key, where in (("score", "score"), ("unseen_network", "unseen network"))
    )
    met, events, nuisances = (sum(point[name]) for name in ("met", "events", "nuisances"))
    return f"{'  '.join(scores)}  {met} of {events} met, {nuisances} nuisances"


def plot(found: dict, path: Path) -> None:
    """Scores over steps, on known networks and on the unseen one, each with the interval of its drives."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4), layout="constrained")
    for axes, key, title in zip(
        figure.subplots(1, 2, sharey=True),
        ("score", "unseen_network"),
        ("unseen seeds", f"unseen network ({found['settings']['unseen']})"),
        strict=True,
    ):
        for colour, (start, curve) in zip(("#1f6fb4", "#c2571a"), found["curves"].items(), strict=False):
            steps = [point["steps"] for point in curve]
            low, high = zip(*(point[f"{key}_between"] for point in curve), strict=True)
            axes.fill_between(steps, low, high, color=colour, alpha=0.15, linewidth=0)
            axes.plot(steps, [point[key] for point in curve], "o-", color=colour, ms=4, label=f"PPO from {start}")
        for name, colour, style in (
            ("rules", "#222222", "-"),
            ("table", "#2e7d32", "--"),
            ("a row per alert", "#2e7d32", ":"),
            ("silent", "#777777", "--"),
        ):
            axes.axhline(found["baselines"][name][key], color=colour, linestyle=style, linewidth=1.2, label=name)
        lowest = min((point[key] for curve in found["curves"].values() for point in curve), default=0.0)
        least = max(-110.0, min(-8.0, lowest - 10))
        axes.set(xlabel="steps of PPO", title=title, ylim=(least, 110), xlim=(0, None))
        axes.spines[["top", "right"]].set_visible(False)
    figure.axes[0].set_ylabel("score")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, frameon=False, loc="outside lower center", ncols=len(labels))
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)


def film(policy, family: str, seed: int, minutes: float, path: Path) -> None:
    """The screen and what the policy does, around each of its alerts, as an animation."""
    frames: list[Image.Image] = []
    before: list[Image.Image] = []
    after = 0
    with closing(FlatDriveEnv(family, minutes=minutes, render_mode="rgb_array")) as env:
        seen, _ = env.reset(seed=seed)
        over, earned = False, 0.0
        while not over:
            number = policy.act(env, seen)
            action, now = ACTIONS[number], env.episode.observation
            seen, reward, terminated, truncated, info = env.step(np.int64(number))
            earned += reward
            said = "waits" if action.kind is None else f"alert: {action.kind.value.replace('_', ' ')}"
            frame = captioned(env.render(), f"{clock(now.time_s)}  {said}", f"reward so far {earned:+.2f}")
            if action.kind is not None:
                frames += [*before[-BEFORE:], frame]
                before, after = [], AFTER
            elif after:
                frames.append(frame)
                after -= 1
            else:
                before.append(frame)
            over = terminated or truncated
    print(f"{family}, seed {seed}: score {info['score']:.0f}, {len(frames)} frames", flush=True)
    if not frames:
        raise SystemExit("the policy gave no alert, so there is nothing to film")
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=FRAME_MS, loop=0, quality=60, method=6)


def clock(time_s: float) -> str:
    return f"{time_s // 60:.0f}:{time_s % 60:02.0f}"


def captioned(screen: np.ndarray, said: str, earned: str) -> Image.Image:
    """A screenshot with a strip below it."""
    width, height = 800, 450
    picture = Image.new("RGB", (width, height + 44), "#ffffff")
    picture.paste(Image.fromarray(screen).resize((width, height), Image.Resampling.LANCZOS))
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(22)
    draw.text((16, height + 9), said, "#b3261e" if "alert" in said else "#333333", font)
    draw.text((width - 16, height + 9), earned, "#333333", font, anchor="ra")
    return picture


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--families", nargs="+", default=list(FAMILIES), help="families of drives to train on")
    parser.add_argument("--unseen", default=UNSEEN, help="a family on a network that is not trained on")
    parser.add_argument(
        "--starts", nargs="+", choices=list(CHEAP), default=["few drives", "imitation"], help="what PPO starts from"
    )
    parser.add_argument("--steps", type=int, default=12_288, help="of PPO, for each start")
    parser.add_argument("--rounds", type=int, default=2, help="measurements during PPO")
    parser.add_argument("--minutes", type=float, default=10.0, help="length of a drive")
    parser.add_argument("--drives", type=int, default=5, help="drives of each family in a measurement")
    parser.add_argument(
        "--few", type=int, default=1, help="the same for watchers whose scores are far from all others"
    )
    parser.add_argument("--demonstrations", type=int, default=33, help="drives of the watcher, of each family")
    parser.add_argument("--corrections", type=int, default=1, help="rounds of drives of the policy, corrected")
    parser.add_argument("--corrected", type=int, default=5, help="drives of each family in such a round")
    parser.add_argument("--lessons", type=Path, help="keep the watcher's drives in this .npz, and read them again")
    parser.add_argument("--epochs", type=int, default=40, help="passes over the lessons")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=None, help="folder for the curve and the policies")
    parser.add_argument(
        "--film",
        nargs="?",
        const="",
        help="film an unseen drive of --unseen: with this policy, as --out writes them, or with the last one",
    )
    chosen = parser.parse_args()
    if chosen.film == "" and not chosen.out:
        parser.error("--film of the last policy requires --out")
    if not chosen.film:
        learn(chosen)
    if chosen.film is not None:
        policy = Path(chosen.film) if chosen.film else chosen.out / f"{named(chosen.starts[-1])}.npz"
        path = policy.with_suffix(".webp") if chosen.film else chosen.out / "ppo_drive.webp"
        film(Network.read(policy), chosen.unseen, FIRST_UNSEEN, chosen.minutes, path)


def named(start: str) -> str:
    """The file of a policy, by what it started from."""
    return f"ppo_drive_{start.replace(' ', '_')}"


def learn(chosen: argparse.Namespace) -> None:
    """Measures the baselines, and trains from each start."""
    if chosen.out:
        chosen.out.mkdir(parents=True, exist_ok=True)
    with closing(Bench(chosen)) as bench:
        settings = {name: value for name, value in vars(chosen).items() if name not in ("out", "lessons", "film")}
        found: dict = {"settings": settings, "baselines": {}, "curves": {}}
        for name, policy in BASELINES.items():
            drives = chosen.drives if isinstance(policy, Table) else chosen.few
            found["baselines"][name] = bench.measured(policy, drives)
            print(f"{name:>13}  {told(found['baselines'][name])}", flush=True)
        for start in chosen.starts:
            curve = found["curves"][start] = []
            for point, policy in train(chosen, start, bench):
                curve.append(point)
                if chosen.out:
                    policy.write(chosen.out / f"{named(start)}.npz")
                    text = json.dumps(found, indent=1)
                    (chosen.out / "ppo_drive.json").write_text(text + "\n", encoding="utf-8")
                    plot(found, chosen.out / "ppo_drive.svg")


if __name__ == "__main__":
    main()
