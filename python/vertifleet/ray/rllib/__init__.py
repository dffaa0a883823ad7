"""Training with RLlib: the networks of layers as modules of its PPO, on native batches of days on any node.

The trained weights are saved as a weight file of the program::

    import vertifleet
    from vertifleet.ray.rllib import export, ppo_config

    settings = vertifleet.settings("paper", n_envs=40, n_steps=500)
    algorithm = ppo_config("paper", "gcaps", settings, env_runners=8).build_algo()
    for _ in range(settings["total_steps"] // (settings["n_envs"] * settings["n_steps"])):
        algorithm.train()
    export(algorithm, "mine.safetensors")
"""

from vertifleet.ray.rllib.config import ppo_config
from vertifleet.ray.rllib.days import FleetDays
from vertifleet.ray.rllib.module import FleetModule
from vertifleet.ray.rllib.weights import export

__all__ = ["FleetDays", "FleetModule", "export", "ppo_config"]
