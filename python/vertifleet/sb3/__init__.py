"""Training with stable-baselines3: the networks as policies of MaskablePPO, on native batches of days.

The trained weights are saved as a weight file of the program::

    import vertifleet
    from sb3_contrib import MaskablePPO
    from vertifleet.sb3 import FleetVecEnv, GcapsPolicy, export, ppo_settings

    settings = vertifleet.settings("paper")
    days = FleetVecEnv("paper", settings["n_envs"], settings["reward"], settings["reward_scale"])
    model = MaskablePPO(GcapsPolicy, days, **ppo_settings(settings), seed=1)
    model.learn(settings["total_steps"])
    export(model, "mine.safetensors")
"""

from vertifleet.sb3.policies import GcapsPolicy, MlpPolicy
from vertifleet.sb3.training import export, ppo_settings
from vertifleet.sb3.vec_env import FleetVecEnv

__all__ = ["FleetVecEnv", "GcapsPolicy", "MlpPolicy", "export", "ppo_settings"]
