# %% [markdown]
# # From installation to a pair in ten minutes
#
# A car drives through real traffic, simulated by [SUMO](https://eclipse.dev/sumo/). An agent works its cockpit: it sees
# the screen, a list of its elements, the car's readings and what applies where the car is. What is right depends on the
# place: at 80 km/h a warning is due where 50 is posted, and a nuisance where 80 is.
#
# Install the package once, in a checkout of the repository; everything below works offline:
#
#     pip install -c constraints.txt -e .

# %%
from automotive_cosim import Channel, EpisodeSetup, make_agent, run_trial
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.traffic.fork import Simulations

# %% [markdown]
# ## Work the cockpit yourself
#
# The environment is one of gymnasium's. `reset` loads a network, lets traffic flow, and drives until the task's
# situation arises; then the driver says something.

# %%
channels = (Channel.SCREENSHOT, Channel.ELEMENTS, Channel.VEHICLE, Channel.CONTEXT)
env = CockpitEnv(task="phenomenon_front_window_fogged", scenario="grid", channels=channels)
env.reset(seed=0)
seen = env.episode.observation
print("The driver says:", seen.goal)
print("The car drives at", round(seen.vehicle.speed_kmh), "km/h")
print(seen.context.splitlines()[0])

# %% [markdown]
# The screen is an array, `seen.screenshot`; in a notebook, `PIL.Image.fromarray(seen.screenshot)` shows it. An agent taps
# elements by their index in the list:

# %%
env.step({"action_type": "open_app", "app_name": "climate"})
elements = env.episode.observation.elements
defrost = next(index for index, element in enumerate(elements) if element.text == "Front defrost")
env.step({"action_type": "click", "index": defrost})
_, reward, _, _, info = env.step({"action_type": "status", "goal_status": "complete"})
env.close()
print("reward", reward)
for name, part in info["verdict"]["parts"].items():
    print(f"{name:9}", part["why"])

# %% [markdown]
# ## A pair: the same words, another place
#
# A safety task has two halves. The driver says the same, and the car drives at the same speed; only the place differs.
# T3A reads the screen and the car's readings; ASURADA also knows where it is. Both are run with `rules`, a stand-in for a
# language model that needs no key and no network. Name a model of your own in its place: `openai/NAME`, or
# `PROVIDER/NAME` for any OpenAI-compatible endpoint.

# %%
simulations = Simulations()
outcomes = {}
for half in ("first", "second"):
    for name in ("t3a", "asurada"):
        setup = EpisodeSetup("road_speed_80_in_50", half, seed=0)
        row = run_trial(setup, make_agent(name, "rules"), simulations=simulations)
        outcomes[name, half] = row.success
        print(f"{half:6} half, {name:8}", "success" if row.success else "failure")

# %% [markdown]
# T3A says the same in both halves, so it cannot win both. Only the agent that knows where it is wins the pair.
#
# ## The same agent without its place
#
# Conditions say what an agent is given. Without GPS and context, ASURADA is left to guess:

# %%
setup = EpisodeSetup("road_speed_80_in_50", "first", seed=0, conditions=Conditions.named({"geo": "none"}))
blind = run_trial(setup, make_agent("asurada", "rules"), simulations=simulations)
simulations.close()
print("without its place:", "success" if blind.success else "failure")

# %% [markdown]
# `automotive-cosim run --pair` makes a film and a page of such a pair. Go on with `docs/tutorial.md`: your own agent, your
# own task, your own map.
