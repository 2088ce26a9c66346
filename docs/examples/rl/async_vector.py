"""gymnasium's AsyncVectorEnv: a process for each environment, with traffic of its own."""

import gymnasium as gym

import automotive_cosim

if __name__ == "__main__":
    envs = gym.make_vec(
        "AutomotiveCosim/Flat-v0", 2, vectorization_mode="async", tasks=("hvac_fan_max",), scenario="grid"
    )
    seen, _ = envs.reset(seed=0)
    for _ in range(8):
        seen, reward, terminated, truncated, _ = envs.step(envs.action_space.sample())
    envs.close()
    print(f"{automotive_cosim.__version__}: observations {seen.shape}")
