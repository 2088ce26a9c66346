"""PPO and imitation learn to watch over drives; their scores on unseen seeds and on an unseen network.

    pip install 'automotive-cosim[rl]' matplotlib
    python benchmarks/ppo_drive.py --out docs/images
    python benchmarks/ppo_drive.py --film docs/images/ppo_drive_imitation.npz      # ppo_drive_imitation.webp

Without a GPU, install torch first, in its CPU build. The policy is a network of two small layers over the numbers
of ``FlatDriveEnv``: two waits and one action per kind of alert. It starts as it is ("scratch") or as an imitation
of the rule-perfect watcher ("imitation"). At first in training, a nuisance costs a share of what the judge takes;
scores are the judge's in all figures: 0 for silence, 100 for the rule-perfect watcher. Training drives have seeds
below 1000, those of measurement 1000 and up; the network of ``--unseen`` is never trained on.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from automotive_cosim.drives.score import LEAST_WORTH, Score, score, together
from automotive_cosim.drives.watchers import AlertOnWake, RulePerfect
from automotive_cosim.envs.flat_drive import ACTIONS, SOON, FlatDriveEnv
from automotive_cosim.exchange.demonstrations import Demonstrated, drives

FAMILIES = ("grid_june", "beauce_june", "alpine_july")
UNSEEN = "nordic_july"
FIRST_UNSEEN = 1000
LAYERS = (128, 128)
SHY = 4.0
"""An untrained policy prefers waits to alerts by this logit: otherwise nine of ten acts are alerts, nearly all of
them cost, and it learns silence before it learns anything else."""
GAMMA = 0.97
CHEAP = {"scratch": 0.05, "imitation": 0.5}
"""The share of a nuisance's cost at the beginning of training, by what it starts from. It rises to the whole cost
by two thirds of the steps: whoever pays in full from the first step learns silence."""
BEFORE, AFTER, FRAME_MS = 2, 3, 700
"""Steps that a film shows before and after an alert, and how long each."""
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
        ])  # fmt: skip


BASELINES = {
    "random": Random(),
    "silent": Silent(),
    "alert on wake": Watcher(AlertOnWake),
    "rules": Watcher(RulePerfect),
}


def one(task: tuple, minutes: float) -> Score:
    """The score of one drive."""
    policy, family, seed = task
    with closing(FlatDriveEnv(family, minutes=minutes)) as env:
        seen, _ = env.reset(seed=seed)
        policy.reset()
        over = False
        while not over:
            seen, _, terminated, truncated, _ = env.step(np.int64(policy.act(env, seen)))
            over = terminated or truncated
        return score(env.episode.judgement, env.episode.seconds)


def demonstrated(task: tuple, minutes: float) -> list[Demonstrated]:
    family, seed = task
    return list(drives([family], [seed], minutes=minutes))


class Bench:
    """Measures policies and demonstrates, in several processes."""

    def __init__(self, chosen: argparse.Namespace) -> None:
        self._chosen = chosen
        self._pool = ProcessPoolExecutor(chosen.workers, multiprocessing.get_context("forkserver"))

    def measured(self, policy) -> dict[str, float]:
        """Scores on unseen seeds of the families, and on the unseen network; what a policy did."""
        given = self._chosen
        seeds = range(FIRST_UNSEEN, FIRST_UNSEEN + given.drives)
        tasks = [(policy, family, seed) for family, seed in product((*given.families, given.unseen), seeds)]
        scores = list(self._pool.map(partial(one, minutes=given.minutes), tasks))
        seen, unseen = together(scores[: -given.drives]), together(scores[-given.drives :])
        return {
            "score": seen.value,
            "unseen_network": unseen.value,
            "events": seen.events,
            "met": seen.met,
            "nuisances": seen.nuisances,
        }

    def demonstrations(self) -> list[Demonstrated]:
        """Steps of the rule-perfect watcher on training drives."""
        given = self._chosen
        tasks = list(product(given.families, range(given.demonstrations)))
        found = self._pool.map(partial(demonstrated, minutes=given.minutes), tasks)
        return [step for steps in found for step in steps]

    def close(self) -> None:
        self._pool.shutdown(cancel_futures=True)


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
    from stable_baselines3.common.vec_env import SubprocVecEnv

    torch.set_num_threads(1)
    envs = make_vec_env(
        partial(made_env, chosen.families, chosen.minutes), n_envs=chosen.workers, seed=chosen.seed,
        vec_env_cls=SubprocVecEnv, vec_env_kwargs={"start_method": "forkserver"},
    )  # fmt: skip
    warm = start == "imitation"
    model = PPO(
        "MlpPolicy", envs, n_steps=min(1024, chosen.steps // chosen.rounds) // chosen.workers, batch_size=128,
        n_epochs=6, gamma=GAMMA,
        learning_rate=1e-4 if warm else 3e-4, ent_coef=0.001 if warm else 0.01, clip_range=0.1 if warm else 0.2,
        target_kl=0.02 if warm else None, policy_kwargs={"net_arch": list(LAYERS)}, seed=chosen.seed, device="cpu",
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


def imitate(model, steps: Sequence[Demonstrated], epochs: int) -> None:
    """Fits policy and value to demonstrations: alerts count more, as there is one to forty waits."""
    import torch

    seen = torch.as_tensor(np.stack([step.observation for step in steps]))
    acts = torch.as_tensor([step.action for step in steps])
    returns = np.zeros(len(steps), np.float32)
    for index in reversed(range(len(steps))):
        last = steps[index].terminated or steps[index].truncated
        returns[index] = lenient(steps[index].reward, CHEAP["imitation"]) + (
            0.0 if last else GAMMA * returns[index + 1]
        )
    worth = torch.as_tensor(returns)
    weights = torch.where(acts < WAITS, 1.0, 4.0)
    optimizer = torch.optim.AdamW(model.policy.parameters(), lr=1e-3, weight_decay=0.01)
    drawn = torch.Generator().manual_seed(0)
    for _ in range(epochs):
        for batch in torch.randperm(len(steps), generator=drawn).split(256):
            values, logs, _ = model.policy.evaluate_actions(seen[batch], acts[batch])
            off = (values[:, 0] - worth[batch]).square()
            loss = (0.1 * off - weights[batch] * logs).mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()


def train(chosen: argparse.Namespace, start: str, bench: Bench, steps: Sequence[Demonstrated]) -> list[dict]:
    """The learning curve: steps, scores and seconds."""
    model = learner(chosen, start)
    if start == "imitation":
        imitate(model, steps, chosen.epochs)
    charging = charges(CHEAP[start], chosen.steps * 2 / 3)
    curve: list[dict] = []
    trained_s = 0.0
    for number in range(chosen.rounds + 1):
        if number:
            began_s = time.monotonic()
            model.learn(chosen.steps // chosen.rounds, charging, reset_num_timesteps=False)
            trained_s += time.monotonic() - began_s
        point = {"steps": model.num_timesteps, "seconds": trained_s, **bench.measured(Network.of(model))}
        curve.append(point)
        print(f"{start:>9}  {point['steps']:7.0f} steps  {told(point)}  {trained_s:5.0f} s", flush=True)
    model.get_env().close()
    if chosen.out:
        Network.of(model).write(chosen.out / f"ppo_drive_{start}.npz")
    return curve


def told(point: dict) -> str:
    return (
        f"score {point['score']:7.1f}  unseen network {point['unseen_network']:7.1f}  "
        f"{point['met']} of {point['events']} met, {point['nuisances']} nuisances"
    )


def plot(found: dict, path: Path) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 3.6), layout="constrained")
    axes = figure.subplots()
    for colour, (start, curve) in zip(("#1f6fb4", "#c2571a"), found["curves"].items(), strict=False):
        steps = [point["steps"] for point in curve]
        for key, style, where in (("score", "o-", "unseen seeds"), ("unseen_network", "o:", "unseen network")):
            axes.plot(steps, [point[key] for point in curve], style, color=colour, ms=4,
                      label=f"PPO from {start}, {where}")  # fmt: skip
    for name, grey in (("alert on wake", "#999999"), ("silent", "#555555"), ("rules", "#222222")):
        value = found["baselines"][name]["score"]
        axes.axhline(max(value, -100), color=grey, linestyle="--", linewidth=1)
        words = f"{name}, {value:.0f}"
        axes.annotate(words, (1, max(value, -100)), xycoords=("axes fraction", "data"), ha="right", va="bottom",
                      fontsize=8, color=grey)  # fmt: skip
    axes.set(xlabel="steps of training", ylabel="score", ylim=(-110, 110), xlim=(0, None))
    axes.legend(fontsize=7, frameon=False, loc="lower right", bbox_to_anchor=(1, 0.1))
    axes.spines[["top", "right"]].set_visible(False)
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
        "--starts", nargs="+", choices=list(CHEAP), default=list(CHEAP), help="what PPO starts from"
    )
    parser.add_argument("--steps", type=int, default=80_000, help="of training, for each start")
    parser.add_argument("--rounds", type=int, default=5, help="measurements during training")
    parser.add_argument("--minutes", type=float, default=10.0, help="length of a drive")
    parser.add_argument("--drives", type=int, default=5, help="drives of each family in a measurement")
    parser.add_argument("--demonstrations", type=int, default=20, help="drives of each family to imitate")
    parser.add_argument("--epochs", type=int, default=40, help="passes over the demonstrations")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=None, help="folder for the curve and the policies")
    parser.add_argument(
        "--film",
        type=Path,
        default=None,
        help="play this policy, as --out writes them, on an unseen drive of --unseen, and film it",
    )
    chosen = parser.parse_args()
    if chosen.film:
        path = chosen.film.with_suffix(".webp")
        film(Network.read(chosen.film), chosen.unseen, FIRST_UNSEEN, chosen.minutes, path)
        return
    if chosen.out:
        chosen.out.mkdir(parents=True, exist_ok=True)
    with closing(Bench(chosen)) as bench:
        found: dict = {"baselines": {}, "curves": {}}
        for name, policy in BASELINES.items():
            found["baselines"][name] = bench.measured(policy)
            print(f"{name:>13}  {told(found['baselines'][name])}", flush=True)
        steps = bench.demonstrations() if "imitation" in chosen.starts else []
        for start in chosen.starts:
            found["curves"][start] = train(chosen, start, bench, steps)
            if chosen.out:
                settings = {name: value for name, value in vars(chosen).items() if name != "out"}
                text = json.dumps({"settings": settings, **found}, indent=1)
                (chosen.out / "ppo_drive.json").write_text(text + "\n", encoding="utf-8")
                plot(found, chosen.out / "ppo_drive.svg")


if __name__ == "__main__":
    main()
