"""PPO learns two explicit-control tasks through the flat view, from below 10 % to above 90 % on unseen seeds.

    pip install 'automotive-cosim[rl]' matplotlib
    python benchmarks/ppo_flat.py --out docs/images

Without a GPU, install torch first, in its CPU build, which saves a few gigabytes. The actions to choose from are
five apps, the fifteen switches of the climate screen and three declarations. Training adds a bonus while the goal
holds (a potential); success is the verdict's in all figures. Seeds 0 to 3 give the traffic for training, 1000 and
up that for measurement.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from automotive_cosim.envs.flat import CONTROLS, FlatEnv

TASKS = ("hvac_fan_max", "hvac_driver_seat_heater")
APPS = ("home", "climate", "map", "vehicle", "media")
CLIMATE = tuple(control for control in CONTROLS if control.startswith("hvac."))
UNSEEN = range(1000, 1010)
EPISODES_PER_SEED = 10
WORKERS = 4


def measured(model) -> float:
    """Share of successes on unseen seeds, with the deterministic policy."""
    env = FlatEnv(TASKS, CLIMATE, APPS, scenario="grid")
    won = 0
    for seed in UNSEEN:
        for number in range(EPISODES_PER_SEED):
            seen, _ = env.reset(seed=seed if number == 0 else None)
            over = False
            while not over:
                action, _ = model.predict(seen, deterministic=False)
                seen, _, terminated, truncated, info = env.step(action)
                over = terminated or truncated
            won += info["is_success"]
    env.close()
    return won / (len(UNSEEN) * EPISODES_PER_SEED)


def train(steps: int, rounds: int, seed: int) -> list[dict[str, float]]:
    """The learning curve: steps, share of successes on unseen seeds, seconds."""
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env

    torch.set_num_threads(1)
    envs = make_vec_env(
        lambda: FlatEnv(TASKS, CLIMATE, APPS, scenario="grid", goal_bonus=0.5), n_envs=WORKERS, seed=0
    )
    model = PPO(
        "MlpPolicy", envs, n_steps=64, batch_size=64, n_epochs=8, learning_rate=1e-3, gamma=0.95, ent_coef=0.02,
        seed=seed,
    )  # fmt: skip
    began_s = time.monotonic()
    curve: list[dict[str, float]] = []
    for number in range(rounds + 1):
        if number:
            model.learn(steps // rounds, reset_num_timesteps=False)
        point = {"steps": model.num_timesteps, "success": measured(model), "seconds": time.monotonic() - began_s}
        curve.append(point)
        print(f"{point['steps']:7.0f} steps  {point['success']:4.0%}  {point['seconds']:5.0f} s", flush=True)
    envs.close()
    return curve


def plot(curve: list[dict[str, float]], path: Path) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 3.4), layout="constrained")
    axes = figure.subplots()
    steps, success = [point["steps"] for point in curve], [100 * point["success"] for point in curve]
    axes.plot(steps, success, "o-", color="#1f6fb4", clip_on=False)
    axes.axhline(90, color="#999999", linestyle=":", linewidth=1)
    axes.set(xlabel="steps of training", ylabel="success on unseen seeds in %", ylim=(0, 102), xlim=(0, None))
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=20_480)
    parser.add_argument("--rounds", type=int, default=5, help="measurements during training")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=None, help="folder for ppo_curve.json and ppo_curve.svg")
    chosen = parser.parse_args()
    curve = train(chosen.steps, chosen.rounds, chosen.seed)
    print(f"{len(APPS) + len(CLIMATE) + 3} actions to choose from")
    print(f"{curve[0]['success']:.0%} untrained, {curve[-1]['success']:.0%} after {curve[-1]['steps']:.0f} steps")
    if chosen.out:
        chosen.out.mkdir(parents=True, exist_ok=True)
        (chosen.out / "ppo_curve.json").write_text(json.dumps(curve, indent=1) + "\n", encoding="utf-8")
        plot(curve, chosen.out / "ppo_curve.svg")


if __name__ == "__main__":
    main()
