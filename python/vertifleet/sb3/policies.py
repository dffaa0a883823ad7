"""The networks as policies of sb3-contrib's MaskablePPO.

Only the network is trained: a features extractor runs all of it, and the layers that stable-baselines3 adds
after an extractor only select logits and value from its output.
"""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any, ClassVar, cast

import torch
from gymnasium import spaces
from sb3_contrib.common.maskable.policies import MaskableActorCriticPolicy
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from torch import Tensor, nn

from vertifleet import Error
from vertifleet.envs.observing import paper_space
from vertifleet.torch import Gcaps, Mlp, Twin
from vertifleet.torch.acting import READ, check_mask
from vertifleet.torch.twin import of_sizes

if TYPE_CHECKING:
    from stable_baselines3.common.type_aliases import Schedule

INFEASIBLE = -1e8
"""Logit of a vertiport that is not feasible, the same number as in MaskablePPO."""
NOT_TAKEN = (
    "net_arch",
    "activation_fn",
    "ortho_init",
    "share_features_extractor",
    "features_extractor_class",
)
"""Arguments of the parent class that would change layers; the network brings its own layers."""


def _take_one_thread() -> None:
    """Limits PyTorch to one thread, unless OMP_NUM_THREADS is set.

    The networks are small: more threads gain little on idle cores, and on busy ones each waits for the
        others, which can take a hundred times as long.
    """
    if "OMP_NUM_THREADS" not in os.environ:
        torch.set_num_threads(1)


class TwinExtractor(BaseFeaturesExtractor):
    """Logits and value of a network: [B, N + 1].

    Args:
        observation_space: the space of an environment's observations.
        kind: class of the network.
        sizes: sizes of its layers; by default those of the shipped weights.
    """

    def __init__(self, observation_space: spaces.Dict, kind: type[Gcaps] | type[Mlp], **sizes: Any) -> None:
        (vertiports,) = cast("tuple[int]", observation_space["action_mask"].shape)
        super().__init__(observation_space, features_dim=vertiports + 1)
        self.twin = of_sizes(kind, vertiports, sizes)

    def forward(self, observations: dict[str, Tensor]) -> Tensor:
        """Logits and value.

        The observed mask is applied here, so that a call without a mask argument, such as plain `predict` or
        `evaluate_policy`, decides as the program does. MaskablePPO gets the same mask from the environment.
        """
        check_mask(observations["action_mask"])
        logits, values = self.twin(observations["nodes"], observations["aircraft"], observations["clock"])
        logits = logits.masked_fill(observations["action_mask"] == 0, INFEASIBLE)
        return torch.cat([logits, values.unsqueeze(-1)], dim=-1)


class Logits(nn.Module):
    """The extractor's outputs without the last."""

    def forward(self, answers: Tensor) -> Tensor:
        """[B, N + 1] -> [B, N]."""
        return answers[:, :-1]


class Value(nn.Module):
    """The last of the extractor's outputs."""

    def forward(self, answers: Tensor) -> Tensor:
        """[B, N + 1] -> [B, 1]."""
        return answers[:, -1:]


class TwinPolicy(MaskableActorCriticPolicy):
    """A network as the policy, including its initial weights.

    The sizes of its layers are given as ``policy_kwargs={"features_extractor_kwargs": {"width": 64}}``.

    Raises:
        Error: V451 if there is no such size, if other layers are requested, or if the environment's
            observations are not those of ``vertifleet/Fleet-v0``.
    """

    kind: ClassVar[type[Gcaps] | type[Mlp]]

    def __init__(
        self,
        observation_space: spaces.Dict,
        action_space: spaces.Discrete[Any],
        lr_schedule: Schedule,
        **settings: Any,
    ) -> None:
        for name in NOT_TAKEN:
            if name in settings:
                rule = f"{type(self).__name__} takes no {name}: its layers are those of {self.kind.kind}"
                hint = 'their sizes are policy_kwargs={"features_extractor_kwargs": {"width": 64}}'
                raise Error("V451", rule, hint)
        _check_shown(observation_space)
        _take_one_thread()
        sizes = settings.get("features_extractor_kwargs") or {}
        fixed: dict[str, Any] = {
            "net_arch": [],
            "ortho_init": False,
            "features_extractor_class": TwinExtractor,
            "features_extractor_kwargs": sizes | {"kind": self.kind},
        }
        super().__init__(observation_space, action_space, lr_schedule, **settings | fixed)

    def _get_constructor_parameters(self) -> dict[str, Any]:
        """The arguments of the constructor from which a saved policy is created again."""
        parameters = super()._get_constructor_parameters()
        taken = {name: value for name, value in parameters.items() if name not in NOT_TAKEN}
        return taken | {"features_extractor_kwargs": self.twin.sizes}

    def _build(self, lr_schedule: Schedule) -> None:
        """Builds the policy as the parent does, but without layers after the extractor."""
        self._build_mlp_extractor()
        self.action_net = Logits()
        self.value_net = Value()  # type: ignore[assignment]  # the parent's has weights
        settings = {"lr": lr_schedule(1), **self.optimizer_kwargs}
        self.optimizer = self.optimizer_class(self.parameters(), **settings)

    @property
    def twin(self) -> Twin:
        """The network that is trained."""
        return cast("TwinExtractor", self.features_extractor).twin


def _check_shown(space: spaces.Space[Any]) -> None:
    """Refuses an environment whose observations are not those that a network reads."""
    hint = "train on vertifleet.sb3.FleetVecEnv, and wrap it in nothing that changes observations"
    shown = space.spaces if isinstance(space, spaces.Dict) else {}
    if any(name not in shown for name in READ):
        raise Error("V451", f"observations must be a dict with {', '.join(READ)}, found {space}", hint)
    vertiports = math.prod(shown["action_mask"].shape or ())
    expected = paper_space(vertiports)
    for name in READ:
        if shown[name].shape != expected[name].shape:
            rule = f"{name} must be {expected[name].shape} with {vertiports} vertiports"
            raise Error("V451", f"{rule}, found {shown[name].shape}", hint)


class GcapsPolicy(TwinPolicy):
    """The paper's network."""

    kind = Gcaps


class MlpPolicy(TwinPolicy):
    """The paper's baseline."""

    kind = Mlp
