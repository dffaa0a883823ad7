"""PPO in one file: learns where aircraft fly next, and is compared with `greedy` on days that it never saw.

Every vertiport is scored by the same small network from what a flight there would mean, so the weights fit
networks of any size. All that the network sees comes from the observation "full". It needs PyTorch:

    python ppo.py --network paper --minutes 5 --out ppo.pt
"""

from __future__ import annotations

import argparse
import time

import numpy as np
import torch
from torch import Tensor, nn
from torch.distributions import Categorical

import vertifleet
from vertifleet import FunctionPolicy
from vertifleet.envs import FleetVectorEnv

REWARD_SCALE = 30.0
"""A day's reward is about 0.035 on `paper`; multiplied by this, it is about 1."""
READY_H = (0.25, 0.5, 1.0, 2.0)
"""Aircraft at a vertiport are counted by whether they are ready within these times."""
FEATURES = 17 + len(READY_H)
"""Numbers that describe a choice."""


def features(seen: dict[str, Tensor]) -> Tensor:
    """What each choice means to the deciding aircraft: [B, N, FEATURES]."""
    place = seen["place"]
    block = seen["choice_block_time"]
    ready = seen["fleet_ready"].unsqueeze(1)
    limits = torch.tensor(READY_H).view(1, -1, 1)
    soon = ((ready <= limits) & (seen["fleet_mask"].unsqueeze(1) == 1)).float()
    waiting = torch.einsum("bka,baj->bjk", soon, seen["fleet_place"]) / 5
    tables = ("demand_left", "demand_next")
    from_here = [torch.einsum("bi,bij->bj", place, seen[table]) / 2 for table in tables]
    leaving = [seen[table].sum(2) / 8 for table in tables]
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
        # What an aircraft could earn from there: the best fares of all who want to leave.
        (seen["demand_left"] * seen["fare"]).amax(2),
        (seen["demand_next"] * seen["fare"]).amax(2),
    ]
    return torch.cat([torch.stack(columns, -1), waiting], -1)


class Agent(nn.Module):
    """Scores every choice, and values the decision."""

    def __init__(self, width: int = 96) -> None:
        super().__init__()
        self.norm = nn.LayerNorm(FEATURES)
        self.embed = nn.Sequential(nn.Linear(FEATURES, width), nn.Tanh())
        self.mix = nn.Sequential(nn.Linear(2 * width, width), nn.Tanh())
        self.score = nn.Linear(width, 1)
        self.value = nn.Sequential(nn.Linear(width, width), nn.Tanh(), nn.Linear(width, 1))
        nn.init.zeros_(self.score.weight)

    def forward(self, choices: Tensor, mask: Tensor) -> tuple[Categorical, Tensor]:
        """The distribution over choices, and the value."""
        each = self.embed(choices)
        all_of_them = each.mean(1, keepdim=True).expand_as(each)
        mixed = self.mix(torch.cat([each, all_of_them], -1))
        logits = self.score(mixed).squeeze(-1).masked_fill(mask == 0, -1e9)
        return Categorical(logits=logits), self.value(mixed.mean(1)).squeeze(-1)


def tensors(observation: dict[str, np.ndarray]) -> dict[str, Tensor]:
    """The parts of observations as tensors, which share their memory."""
    return {name: torch.as_tensor(array) for name, array in observation.items()}


class Rollout:
    """The decisions of one iteration, [steps, days]."""

    def __init__(self, steps: int, days: int, vertiports: int) -> None:
        self.choices = torch.zeros(steps, days, vertiports, FEATURES)
        self.masks = torch.zeros(steps, days, vertiports)
        self.actions = torch.zeros(steps, days, dtype=torch.long)
        self.log_probs, self.values, self.rewards, self.ends = (torch.zeros(steps, days) for _ in range(4))

    def advantages(self, last_value: Tensor, gamma: float, trace: float) -> Tensor:
        """Generalised advantage estimates."""
        advantages, following, value = (
            torch.zeros_like(self.rewards),
            torch.zeros_like(last_value),
            last_value,
        )
        for step in reversed(range(len(self.rewards))):
            goes_on = 1 - self.ends[step]
            delta = self.rewards[step] + gamma * value * goes_on - self.values[step]
            following = delta + gamma * trace * goes_on * following
            advantages[step], value = following, self.values[step]
        return advantages


def learn(
    agent: Agent,
    optimizer: torch.optim.Optimizer,
    rollout: Rollout,
    last_value: Tensor,
    args: argparse.Namespace,
) -> None:
    """Improves the agent by the clipped objective of PPO."""
    advantages = rollout.advantages(last_value, args.gamma, args.trace)
    returns = (advantages + rollout.values).flatten()
    flat = [
        part.flatten(0, 1)
        for part in (rollout.choices, rollout.masks, rollout.actions, rollout.log_probs, advantages)
    ]
    for _ in range(args.passes):
        for batch in torch.split(torch.randperm(len(returns)), args.batch):
            choices, masks, actions, log_probs, advantage = (part[batch] for part in flat)
            distribution, values = agent(choices, masks)
            advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
            ratio = (distribution.log_prob(actions) - log_probs).exp()
            gain = torch.min(ratio * advantage, ratio.clamp(1 - args.clip, 1 + args.clip) * advantage)
            loss = -gain.mean() + 0.5 * (values - returns[batch]).square().mean()
            loss = loss - args.entropy * distribution.entropy().mean()
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            optimizer.step()


def train(agent: Agent, args: argparse.Namespace) -> None:
    """Learns until the time is up."""
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
            with torch.no_grad():
                distribution, rollout.values[step] = agent(rollout.choices[step], rollout.masks[step])
            rollout.actions[step] = distribution.sample()
            rollout.log_probs[step] = distribution.log_prob(rollout.actions[step])
            observation, rewards, over, _, info = envs.step(rollout.actions[step].numpy())
            rollout.rewards[step] = torch.as_tensor(REWARD_SCALE * rewards)
            rollout.ends[step] = torch.as_tensor(over)
            if over.any():
                day_profits += info["final_info"]["summary"]["profit_usd"][over].tolist()
        with torch.no_grad():
            last = agent(features(tensors(observation)), torch.as_tensor(observation["action_mask"]))[1]
        learn(agent, optimizer, rollout, last, args)
        decisions += args.steps * args.days
        recent = np.mean(day_profits[-200:]) if day_profits else float("nan")
        print(
            f"{decisions:>10,} decisions, {time.monotonic() - begun:4.0f} s, $ {recent:,.0f} a day",
            flush=True,
        )


def main() -> None:
    """Learns, saves the weights, and compares."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--network", default="paper")
    parser.add_argument("--minutes", type=float, default=5.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="ppo.pt")
    parser.add_argument("--days", type=int, default=64, help="days played side by side")
    parser.add_argument("--steps", type=int, default=128, help="decisions of each before an update")
    parser.add_argument("--batch", type=int, default=1024)
    parser.add_argument("--passes", type=int, default=3)
    parser.add_argument("--learning-rate", type=float, default=2e-3)
    parser.add_argument("--gamma", type=float, default=1.0)
    parser.add_argument("--trace", type=float, default=0.8, help="lambda of the advantage estimates")
    parser.add_argument("--clip", type=float, default=0.2)
    parser.add_argument("--entropy", type=float, default=0.003)
    args = parser.parse_args()
    torch.manual_seed(args.seed)
    torch.set_num_threads(1)
    agent = Agent()
    try:
        train(agent, args)
    except KeyboardInterrupt:
        print("stopped: what was learned so far is saved and compared")
    torch.save(agent.state_dict(), args.out)

    def choose(observation: dict[str, np.ndarray]) -> int:
        seen = tensors({name: array[None] for name, array in observation.items()})
        with torch.no_grad():
            return int(agent(features(seen), seen["action_mask"])[0].probs.argmax())

    models = {"ppo": FunctionPolicy(choose, "full")}
    print(vertifleet.compare(args.network, ["greedy", "ppo"], days=20, models=models))


if __name__ == "__main__":
    main()
