"""PPO in one file, with numpy alone: a policy that learns eight wishes about the cabin's climate in ten minutes.

    python docs/examples/rl/ten_minutes.py runs/ten_minutes

The driver says "My knuckles are turning blue." and the policy has to open the climate screen, tap the one right
switch and declare that it is done. Success is the verdict's, on seeds that it was not trained on.
"""

import sys
import time
from itertools import islice
from math import sqrt
from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image, ImageDraw

import automotive_cosim

FOLDER, MINUTES, EPISODES = [*sys.argv[1:], *("runs/ten_minutes", 10, 200)[len(sys.argv) - 1 :]]
WISHES = "fan_max driver_seat_heater air_direction cold_hands stuffy cold_leather cold_toes wife_cold"
SMALL = {"tasks": [f"hvac_{name}" for name in WISHES.split()], "scenario": "grid", "max_steps": 6}
SMALL["apps"] = ("climate", "vehicle", "media", "map", "phone")
COUNT, STEPS, EPOCHS, BATCH = 8, 32, 8, 64  # environments, their steps before an update, passes over these, samples
GAMMA, LAMBDA, CLIP, ENTROPY, RATE = 0.95, 0.95, 0.2, 0.02, 2e-3
UNSEEN, rng = 1000, np.random.default_rng(0)  # the first of the seeds that are measured


class Net:
    """Two layers with a tanh between them, and Adam."""

    def __init__(self, inputs, outputs, width=64):
        start = np.random.default_rng(0)
        self.weights = [start.normal(0, inputs**-0.5, (inputs, width)), np.zeros(width)]
        self.weights += [start.normal(0, 0.01, (width, outputs)), np.zeros(outputs)]
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
            weight -= RATE * mean / (1 - 0.9**self.steps) / (np.sqrt(square / (1 - 0.999**self.steps)) + 1e-8)


def chances(actor, seen, allowed):
    """The policy: how likely each action is; one that does nothing on the present screen is not."""
    scores = np.where(allowed, actor(seen), -1e9)
    powers = np.exp(scores - scores.max(-1, keepdims=True))
    return powers / powers.sum(-1, keepdims=True)


def played(envs, actor, **given):
    """Steps of every environment: what was seen, allowed, done, how likely, paid, over, begun, won."""
    seen, info = envs.reset(**given)
    envs.now = seen, np.stack(info["action_mask"]), np.zeros(len(seen), bool)
    while True:
        seen, allowed, begun = envs.now
        likely = chances(actor, seen, allowed)
        acts = (likely.cumsum(-1) > rng.random((len(likely), 1))).argmax(-1)
        after, reward, terminated, truncated, info = envs.step(acts)
        envs.now = after, np.stack(info["action_mask"]), terminated | truncated
        won = np.asarray(info.get("is_success", begun & False), bool)
        yield seen, allowed, acts, likely[range(len(acts)), acts], reward, envs.now[2], begun, won


def update(actor, critic, rows, last):
    """PPO; a step that only began an episode teaches nothing."""
    seen, allowed, acts, likely, rewards, over, begun, _ = map(np.stack, zip(*rows, strict=True))
    values, gains, gain = [*critic(seen)[..., 0], critic(last)[:, 0]], np.zeros_like(rewards), 0.0
    for at in reversed(range(STEPS)):
        gains[at] = gain = rewards[at] + GAMMA * ~over[at] * (values[at + 1] + LAMBDA * gain) - values[at]
    goals = gains + np.stack(values[:-1])
    seen, allowed, acts, likely, goals, gains = (x[~begun] for x in (seen, allowed, acts, likely, goals, gains))
    gains = (gains - gains.mean()) / (gains.std() + 1e-8)
    for _ in range(EPOCHS):
        for part in np.array_split(rng.permutation(len(acts)), len(acts) // BATCH + 1):
            now, gain, at = chances(actor, seen[part], allowed[part]), gains[part], (range(len(part)), acts[part])
            ratio = now[at] / likely[part]
            pull = np.where(gain > 0, ratio < 1 + CLIP, ratio > 1 - CLIP) * ratio * gain
            slope = pull[:, None] * now
            slope[at] -= pull
            logs = np.log(now + 1e-12)
            slope += ENTROPY * now * (logs - (now * logs).sum(1, keepdims=True))
            actor.learn(slope / len(part))
            critic.learn((critic(seen[part])[:, 0] - goals[part])[:, None] / len(part))


def measured(envs, actor, z=1.96):
    """Success over unseen episodes, as many of every environment, with Wilson's interval of 95 %."""
    won, ended, each = np.zeros(COUNT, int), np.zeros(COUNT, int), int(EPISODES) // COUNT
    for *_, over, _, solved in played(envs, actor, seed=[*range(UNSEEN, UNSEEN + COUNT)]):
        won, ended = won + (solved & (ended < each)), ended + over
        if ended.min() >= each:
            break
    of, count = int(won.sum()), each * COUNT
    half = z * sqrt(of * (count - of) / count + z * z / 4)
    low, high = ((of + z * z / 2 + side) / (count + z * z) for side in (-half, half))
    return f"{of} of {count} unseen episodes, {of / count:.0%} ({low:.0%} to {high:.0%})"


def film(actors, path):
    """The policies side by side, with the same wishes in the same traffic."""
    envs, pages = gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=2, render_mode="rgb_array", **SMALL), []
    for seed in range(UNSEEN + 1, UNSEEN + 4):
        screens, ends = [None, None], ["", ""]
        given = {"seed": [seed] * 2, "options": {"traffic_seed": UNSEEN}}
        steps = played(envs, lambda seen: np.stack([each(seen)[n] for n, each in enumerate(actors)]), **given)
        while not all(ends):
            *_, over, _, solved = next(steps)
            pages += [page := Image.new("RGB", (1080, 372), "white")]
            text = ImageDraw.Draw(page).text
            for n, name in enumerate(("untrained", "trained")):
                if not ends[n]:
                    screens[n] = Image.fromarray(envs.render()[n]).resize((528, 297))
                    ends[n] = (": solved" if solved[n] else ": not solved") if over[n] else ""
                    goal = envs.envs[n].unwrapped.episode.observation.goal
                page.paste(screens[n], (6 + 540 * n, 40))
                text((12 + 540 * n, 342), name + ends[n], "black", font_size=20)
            text((12, 8), f"“{goal}”", "black", font_size=20)
        pages += [page, page]
    envs.close()
    pages[0].save(path, save_all=True, append_images=pages[1:], duration=1000, loop=0, quality=60, method=6)


if __name__ == "__main__":
    envs = gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=COUNT, goal_bonus=0.5, **SMALL)
    inputs, actions = envs.single_observation_space.shape[0], int(envs.single_action_space.n)
    untrained, actor, critic = (Net(inputs, outputs) for outputs in (actions, actions, 1))
    print("before:", measured(envs, untrained), flush=True)
    began, rounds, steps = time.monotonic(), 0, played(envs, actor, seed=[*range(COUNT)])
    while (minutes := (time.monotonic() - began) / 60) < float(MINUTES):
        rows = list(islice(steps, STEPS))
        update(actor, critic, rows, envs.now[0])
        if (rounds := rounds + 1) % 10 == 1:
            won, over = (sum(int(row[at].sum()) for row in rows) for at in (7, 5))
            print(f"{minutes:4.1f} min, {rounds * STEPS * COUNT} steps: {won} of {over} solved", flush=True)
    print("after:", measured(envs, actor), flush=True)
    Path(FOLDER).mkdir(parents=True, exist_ok=True)
    film((untrained, actor), Path(FOLDER) / "ten_minutes.webp")
    print(f"{automotive_cosim.__version__}: the film is {FOLDER}/ten_minutes.webp")
