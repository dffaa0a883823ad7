"""PPO in one file: learns where aircraft fly next, and is compared with `greedy` on validation days.

The same small network scores every vertiport from features of a flight there, so the weights fit networks of
any size. The value reads the whole fleet, regardless of the deciding aircraft: above all the hours that
aircraft can still fly, which a long flight uses up. Both read the observation "full". It needs PyTorch:

    python ppo.py --network paper --minutes 5 --out ppo.pt
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import torch
from torch import Tensor, nn
from torch.distributions import Categorical
from torch.optim.swa_utils import AveragedModel

import vertifleet
from vertifleet import FunctionPolicy
from vertifleet.envs import FleetVectorEnv

REWARD_SCALE = 30.0
"""A day's reward is about 0.035 on `paper`; multiplied by this, it is about 1."""
DEMAND = (("demand_left", "fare"), ("demand_next", "fare_next"))
"""Tables of demand, with the tables of its fares."""
READY_H = (0.25, 0.5, 1.0, 2.0)
"""Aircraft at a vertiport are counted that are ready within each of these times."""
FEATURES = 17 + len(READY_H)
"""Numbers that describe a choice."""
PLACES = 10 + len(READY_H)
"""Numbers that describe a vertiport to the value."""


def onward(seen: dict[str, Tensor]) -> list[Tensor]:
    """The highest hourly profit of a flight from each vertiport, before energy, now and next: [B, N] each."""
    seats = torch.einsum("bt,bt->b", seen["aircraft_type"], seen["types"][:, :, 0]).view(-1, 1, 1)
    hours = seen["block_time"].clamp(min=0.25) / seen["reachable"].clamp(min=1e-6)
    margins = [(seen[fare] - seen["passenger_cost"]).clamp(min=0) for _, fare in DEMAND]
    loads = [torch.minimum(seen[table], seats) for table, _ in DEMAND]
    return [(10 * load * margin / hours).amax(2) for load, margin in zip(loads, margins, strict=True)]


def soon_ready(seen: dict[str, Tensor]) -> Tensor:
    """How many aircraft at or towards each vertiport are ready within the limits: [B, N, limits]."""
    limits = torch.tensor(READY_H).view(1, -1, 1)
    soon = (seen["fleet_ready"].unsqueeze(1) <= limits) & (seen["fleet_mask"].unsqueeze(1) == 1)
    return torch.einsum("bka,baj->bjk", soon.float(), seen["fleet_place"]) / 5


def features(seen: dict[str, Tensor]) -> Tensor:
    """The features of each choice for the deciding aircraft: [B, N, FEATURES]."""
    place = seen["place"]
    block = seen["choice_block_time"]
    from_here = [torch.einsum("bi,bij->bj", place, seen[table]) / 2 for table, _ in DEMAND]
    leaving = [seen[table].sum(2) / 8 for table, _ in DEMAND]
    columns = [
        place,
        seen["choice_profit"],
        seen["choice_profit"] / block.clamp(min=0.25),
        4 * seen["choice_passengers"],
        block,
        *from_here,
        *leaving,
        seen["demand_left"].sum(1) / 8,
        seen["stands"] - seen["stands_taken"],
        seen["stands_taken"],
        *(seen["time"][:, at, None].expand_as(place) for at in range(3)),
        *onward(seen),
    ]
    return torch.cat([torch.stack(columns, -1), soon_ready(seen)], -1)


def places(seen: dict[str, Tensor]) -> Tensor:
    """The value's features of every vertiport, which do not depend on the deciding aircraft: [B, N, PLACES].

    The first four numbers are the same for all vertiports: the time, and the hours that aircraft have left.
    """
    exists = seen["fleet_mask"]
    hours = ((12 * seen["time"][:, :1] - seen["fleet_ready"]).clamp(min=0) * exists).sum(1) / exists.sum(1)
    columns = [
        *(one[:, None].expand_as(seen["stands"]) for one in (*seen["time"].T, hours / 6)),
        seen["stands"] - seen["stands_taken"],
        seen["stands_taken"],
        *(seen[table].sum(2) / 8 for table, _ in DEMAND),
        *onward(seen),
    ]
    return torch.cat([torch.stack(columns, -1), soon_ready(seen)], -1)


class Agent(nn.Module):
    """Scores every choice, and values the state of the fleet."""

    def __init__(self, width: int = 96) -> None:
        super().__init__()
        self.norm = nn.LayerNorm(FEATURES)
        self.embed = nn.Sequential(nn.Linear(FEATURES, width), nn.Tanh())
        self.mix = nn.Sequential(nn.Linear(2 * width, width), nn.Tanh())
        self.score = nn.Linear(width, 1)
        self.place = nn.Sequential(nn.Linear(PLACES, width), nn.Tanh())
        self.value = nn.Sequential(nn.Linear(width, width), nn.Tanh(), nn.Linear(width, 1))
        self.hours = nn.Linear(4, 1)
        nn.init.zeros_(self.score.weight)
        nn.init.zeros_(self.value[-1].weight)  # type: ignore[arg-type]

    def forward(self, choices: Tensor, mask: Tensor) -> Categorical:
        """The distribution over choices."""
        each = self.embed(choices)
        all_of_them = each.mean(1, keepdim=True).expand_as(each)
        mixed = self.mix(torch.cat([each, all_of_them], -1))
        logits = self.score(mixed).squeeze(-1).masked_fill(mask == 0, -1e9)
        return Categorical(logits=logits)

    def worth(self, places: Tensor) -> Tensor:
        """The value: the expected remaining reward of the day."""
        value: Tensor = self.value(self.place(places).mean(1)) + self.hours(places[:, 0, :4])
        return value.squeeze(-1)


def tensors(observation: dict[str, np.ndarray]) -> dict[str, Tensor]:
    """The parts of observations as tensors, which share their memory."""
    return {name: torch.as_tensor(array) for name, array in observation.items()}


class Rollout:
    """The decisions of one iteration, [steps, days]."""

    def __init__(self, steps: int, days: int, vertiports: int) -> None:
        self.choices = torch.zeros(steps, days, vertiports, FEATURES)
        self.masks = torch.zeros(steps, days, vertiports)
        self.places = torch.zeros(steps, days, vertiports, PLACES)
        self.actions = torch.zeros(steps, days, dtype=torch.long)
        self.log_probs, self.values, self.rewards, self.ends = (torch.zeros(steps, days) for _ in range(4))

    def advantages(self, last_value: Tensor, trace: float) -> Tensor:
        """Generalised advantage estimates; a day ends, so nothing is discounted."""
        advantages, following = torch.zeros_like(self.rewards), torch.zeros_like(last_value)
        value = last_value
        for step in reversed(range(len(self.rewards))):
            goes_on = 1 - self.ends[step]
            delta = self.rewards[step] + value * goes_on - self.values[step]
            following = delta + trace * goes_on * following
            advantages[step], value = following, self.values[step]
        return advantages


def learn(
    agent: Agent,
    averaged: AveragedModel,
    optimizer: torch.optim.Optimizer,
    rollout: Rollout,
    last_value: Tensor,
    args: argparse.Namespace,
) -> None:
    """Improves the agent by the clipped objective of PPO."""
    advantages = rollout.advantages(last_value, args.trace)
    returns = (advantages + rollout.values).flatten()
    kept = (rollout.choices, rollout.masks, rollout.places, rollout.actions, rollout.log_probs, advantages)
    flat = [part.flatten(0, 1) for part in kept]
    for _ in range(args.passes):
        for batch in torch.split(torch.randperm(len(returns)), args.batch):
            choices, masks, seen, actions, log_probs, advantage = (part[batch] for part in flat)
            distribution, values = agent(choices, masks), agent.worth(seen)
            advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
            ratio = (distribution.log_prob(actions) - log_probs).exp()
            gain = torch.min(ratio * advantage, ratio.clamp(1 - args.clip, 1 + args.clip) * advantage)
            loss = -gain.mean() + 0.5 * (values - returns[batch]).square().mean()
            loss = loss - args.entropy * distribution.entropy().mean()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            optimizer.step()
            averaged.update_parameters(agent)


def train(agent: Agent, averaged: AveragedModel, args: argparse.Namespace) -> None:
    """Learns until the time is up. The average of the latest weights chooses better than the last ones."""
    envs = FleetVectorEnv(
        args.days, args.network, "dense", autoreset_mode="SameStep", observation="full", copy=False
    )
    observation, _ = envs.reset(seed=args.seed)
    optimizer = torch.optim.Adam(agent.parameters(), lr=args.learning_rate, eps=1e-5)
    rollout = Rollout(args.steps, args.days, observation["place"].shape[1])
    begun, decisions, day_profits = time.monotonic(), 0, []
    while (share := (time.monotonic() - begun) / (60 * args.minutes)) < 1:
        optimizer.param_groups[0]["lr"] = args.learning_rate * (1 - share)
        for step in range(args.steps):
            seen = tensors(observation)
            rollout.choices[step], rollout.masks[step] = features(seen), seen["action_mask"]
            rollout.places[step] = places(seen)
            with torch.no_grad():
                distribution = agent(rollout.choices[step], rollout.masks[step])
                rollout.values[step] = agent.worth(rollout.places[step])
            rollout.actions[step] = distribution.sample()
            rollout.log_probs[step] = distribution.log_prob(rollout.actions[step])
            observation, rewards, over, _, info = envs.step(rollout.actions[step].numpy())
            rollout.rewards[step] = torch.as_tensor(REWARD_SCALE * rewards)
            rollout.ends[step] = torch.as_tensor(over)
            if over.any():
                day_profits += info["final_info"]["summary"]["profit_usd"][over].tolist()
        with torch.no_grad():
            last = agent.worth(places(tensors(observation)))
        learn(agent, averaged, optimizer, rollout, last, args)
        decisions += args.steps * args.days
        seconds, recent = time.monotonic() - begun, np.mean(day_profits[-200:] or [np.nan])
        print(f"{decisions:>10,} decisions, {seconds:4.0f} s, $ {recent:,.0f} a day", flush=True)


def main() -> None:
    """Learns, saves the weights, and compares."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("--network", default="paper")
    parser.add_argument("--minutes", type=float, default=5.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="ppo.pt")
    parser.add_argument("--days", type=int, default=64, help="days played side by side")
    parser.add_argument("--steps", type=int, default=128, help="decisions of each before an update")
    parser.add_argument("--batch", type=int, default=1024)
    parser.add_argument("--passes", type=int, default=3)
    parser.add_argument("--learning-rate", type=float, default=1e-3)
    parser.add_argument("--trace", type=float, default=0.7, help="lambda of the advantage estimates")
    parser.add_argument("--clip", type=float, default=0.2)
    parser.add_argument("--entropy", type=float, default=0.001)
    args = parser.parse_args()
    torch.manual_seed(args.seed)
    torch.set_num_threads(1)
    agent = Agent()
    averaged = AveragedModel(agent, avg_fn=lambda old, new, _: old + 0.002 * (new - old))
    try:
        train(agent, averaged, args)
    except KeyboardInterrupt:
        print("stopped: what was learned so far is saved and compared")
    agent.load_state_dict(averaged.module.state_dict())
    torch.save(agent.state_dict(), args.out)

    def choose(observation: dict[str, np.ndarray]) -> np.ndarray:
        seen = tensors(observation)
        with torch.no_grad():
            return np.asarray(agent(features(seen), seen["action_mask"]).probs.argmax(1))

    models = {"ppo": FunctionPolicy(choose, "full", batch=True)}
    print(vertifleet.compare(args.network, ["greedy", "ppo"], days=100, split="validation", models=models))


if __name__ == "__main__":
    main()
