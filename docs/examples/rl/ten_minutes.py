"""A policy that learns in ten minutes: PPO in one file, with numpy alone, on eight wishes about the cabin's climate.

    python docs/examples/rl/ten_minutes.py --out runs/ten_minutes

The driver says "My knuckles are turning blue." and the policy has to open the climate screen, find the one right
switch of fifteen, and declare that it is done. Success is the verdict's, over episodes of seeds that were not trained
on, before and after; the film has both policies with the same wishes in the same traffic.
"""

import argparse
import time
from math import sqrt
from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image, ImageDraw, ImageFont

import automotive_cosim  # noqa: F401  registers the environments

TASKS = (
    *("hvac_fan_max", "hvac_driver_seat_heater", "hvac_air_direction", "hvac_cold_hands"),
    *("hvac_stuffy", "hvac_cold_leather", "hvac_cold_toes", "hvac_wife_cold"),
)
SMALL = {"scenario": "grid", "apps": ("climate", "vehicle", "media", "map", "phone"), "max_steps": 6}
COUNT, STEPS, EPOCHS, BATCH = 8, 32, 4, 128
"""Environments side by side, steps of each between two updates, passes over these, samples a gradient."""
GAMMA, LAMBDA, CLIP, ENTROPY, RATE = 0.95, 0.95, 0.2, 0.01, 3e-3
UNSEEN = 1000
"""The first seed that is measured; training takes those from 0."""


class Net:
    """Two layers with a tanh between them, and Adam."""

    def __init__(self, rng, inputs, outputs, width=64, last=0.01):
        self.weights = [
            *(rng.normal(0, inputs**-0.5, (inputs, width)), np.zeros(width)),
            *(rng.normal(0, last, (width, outputs)), np.zeros(outputs)),
        ]
        self.moments = [(np.zeros_like(each), np.zeros_like(each)) for each in self.weights]
        self.steps = 0

    def __call__(self, seen):
        self.seen, self.hidden = seen, np.tanh(seen @ self.weights[0] + self.weights[1])
        return self.hidden @ self.weights[2] + self.weights[3]

    def learn(self, slope):
        """One step down, from the loss's derivative by what the last call gave."""
        inner = slope @ self.weights[2].T * (1 - self.hidden**2)
        self.steps += 1
        found = (self.seen.T @ inner, inner.sum(0), self.hidden.T @ slope, slope.sum(0))
        for weight, (mean, square), each in zip(self.weights, self.moments, found, strict=True):
            mean += 0.1 * (each - mean)
            square += 0.001 * (each**2 - square)
            size = np.sqrt(square / (1 - 0.999**self.steps)) + 1e-8
            weight -= RATE * mean / (1 - 0.9**self.steps) / size


def chances(actor, seen, allowed):
    """The policy: how likely each action is, and none that does nothing on the present screen."""
    scores = np.where(allowed, actor(seen), -1e9)
    powers = np.exp(scores - scores.max(-1, keepdims=True))
    return powers / powers.sum(-1, keepdims=True)


def chosen(rng, likely):
    """An action drawn for each row."""
    return (likely.cumsum(-1) > rng.random((len(likely), 1))).argmax(-1)


def update(rng, actor, critic, told):
    """PPO over one collection; of each environment the steps that only began an episode are left out."""
    seen, allowed, acts, likely, rewards, over, begun, last = told
    values = np.concatenate([critic(seen)[..., 0], critic(last)[None, :, 0]])
    gains, gain = np.zeros_like(rewards), 0.0
    for at in reversed(range(STEPS)):
        goes_on = 1.0 - over[at]
        error = rewards[at] + GAMMA * goes_on * values[at + 1] - values[at]
        gains[at] = gain = error + GAMMA * LAMBDA * goes_on * gain
    counted = np.flatnonzero(~begun.ravel())
    goals = (gains + values[:-1]).ravel()
    seen, allowed, gains = seen.reshape(-1, seen.shape[-1]), allowed.reshape(-1, allowed.shape[-1]), gains.ravel()
    gains = (gains - gains[counted].mean()) / (gains[counted].std() + 1e-8)
    for _ in range(EPOCHS):
        for part in np.array_split(rng.permutation(counted), max(1, len(counted) // BATCH)):
            now, taken = chances(actor, seen[part], allowed[part]), acts.ravel()[part]
            row = np.arange(len(part))
            ratio, gain = now[row, taken] / likely.ravel()[part], gains[part]
            moves = np.where(gain > 0, ratio < 1 + CLIP, ratio > 1 - CLIP) * ratio * gain
            slope = moves[:, None] * now
            slope[row, taken] -= moves
            logs = np.log(now + 1e-12)
            slope += ENTROPY * now * (logs - (now * logs).sum(1, keepdims=True))
            actor.learn(slope / len(part))
            critic.learn((critic(seen[part])[:, 0] - goals[part])[:, None] / len(part))


def collected(rng, envs, actor, state):
    """So many steps of every environment, as ``update`` takes them, and where they stand then."""
    seen, allowed, begun = state
    rows = []
    for _ in range(STEPS):
        likely = chances(actor, seen, allowed)
        acts = chosen(rng, likely)
        after, reward, terminated, truncated, info = envs.step(acts)
        over = terminated | truncated
        rows.append((seen, allowed, acts, likely[np.arange(COUNT), acts], reward, over, begun))
        seen, allowed, begun = after, np.stack(info["action_mask"]), over
    return (*(np.stack(each) for each in zip(*rows, strict=True)), seen), (seen, allowed, begun)


def success(envs, actor, episodes, rng):
    """Of so many episodes of every environment on unseen seeds: how many were won, and how many there were."""
    won, ended = np.zeros(COUNT, int), np.zeros(COUNT, int)
    seen, info = envs.reset(seed=UNSEEN)
    while ended.min() < episodes:
        acts = chosen(rng, chances(actor, seen, np.stack(info["action_mask"])))
        seen, _, terminated, truncated, info = envs.step(acts)
        over = (terminated | truncated) & (ended < episodes)
        won += over & np.asarray(info.get("is_success", np.zeros(COUNT)), bool)
        ended += over
    return int(won.sum()), int(ended.sum())


def told(won, count, z=1.96):
    """A rate with Wilson's interval of 95 %."""
    middle, half = won + z * z / 2, z * sqrt(won * (count - won) / count + z * z / 4)
    low, high = ((middle + sign * half) / (count + z * z) for sign in (-1, 1))
    return f"{won} of {count} episodes, {won / count:.0%} ({low:.0%} to {high:.0%})"


def played(actor, seed):
    """The screens of one unseen episode, what was said, and whether it was won."""
    env = gym.make("AutomotiveCosim/Flat-v0", tasks=TASKS, render_mode="rgb_array", **SMALL)
    seen, info = env.reset(seed=seed, options={"traffic_seed": UNSEEN})
    rng, over, screens = np.random.default_rng(seed), False, [env.render()]
    while not over:
        act = chosen(rng, chances(actor, seen[None], info["action_mask"][None]))[0]
        seen, _, terminated, truncated, info = env.step(act)
        over = terminated or truncated
        screens.append(env.render())
    goal = env.unwrapped.episode.observation.goal
    env.close()
    return screens, goal, info["is_success"]


def film(before, after, seeds, path):
    """Both policies, side by side, second by second."""
    font, frames = ImageFont.load_default(20), []
    for seed in seeds:
        plays = [played(each, seed) for each in (before, after)]
        longest = max(len(screens) for screens, _, _ in plays)
        for at in range(longest + 1):
            page = Image.new("RGB", (1080, 372), "white")
            draw = ImageDraw.Draw(page)
            draw.text((12, 8), f"“{plays[0][1]}”", "black", font)
            for side, (name, (screens, _, won)) in enumerate(zip(("untrained", "trained"), plays, strict=True)):
                shown = Image.fromarray(screens[min(at, len(screens) - 1)]).resize((528, 297))
                page.paste(shown, (6 + side * 540, 40))
                verdict = ("solved" if won else "not solved") if at >= len(screens) - 1 else f"step {at}"
                draw.text((12 + side * 540, 342), f"{name}: {verdict}", "black", font)
            frames.append(page)
    waits = [1000] * len(frames)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=waits, loop=0, quality=60, method=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--minutes", type=float, default=10.0, help="of training")
    parser.add_argument("--episodes", type=int, default=200, help="measured, before and after")
    parser.add_argument("--seed", type=int, default=0, help="of the network's weights and of what is drawn")
    parser.add_argument("--out", type=Path, default=Path("runs/ten_minutes"), help="folder of the film")
    given = parser.parse_args()
    rng = np.random.default_rng(given.seed)
    envs = gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=COUNT, tasks=TASKS, goal_bonus=0.5, **SMALL)
    inputs, actions = envs.single_observation_space.shape[0], int(envs.single_action_space.n)
    untrained, actor, critic = (Net(np.random.default_rng(given.seed), inputs, n) for n in (actions, actions, 1))
    each = -(-given.episodes // COUNT)
    print("before:", told(*success(envs, untrained, each, rng)), flush=True)
    seen, info = envs.reset(seed=given.seed)
    state = seen, np.stack(info["action_mask"]), np.zeros(COUNT, bool)
    began, steps, shown = time.monotonic(), 0, 0
    while time.monotonic() - began < given.minutes * 60:
        part, state = collected(rng, envs, actor, state)
        update(rng, actor, critic, part)
        steps += STEPS * COUNT
        if time.monotonic() - began >= 60 * shown:
            shown += 1
            reward = part[4].sum() / max(1, part[5].sum())
            print(f"{(time.monotonic() - began) / 60:4.1f} min, {steps} steps, {reward:.2f} an episode", flush=True)
    print("after:", told(*success(envs, actor, each, rng)), flush=True)
    envs.close()
    given.out.mkdir(parents=True, exist_ok=True)
    film(untrained, actor, range(UNSEEN + 1, UNSEEN + 4), given.out / "before_after.webp")
    print(f"{steps} steps in {given.minutes:g} minutes; the film is {given.out / 'before_after.webp'}")


if __name__ == "__main__":
    main()
