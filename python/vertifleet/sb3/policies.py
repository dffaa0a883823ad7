"""The networks as policies of sb3-contrib's MaskablePPO.

What is trained is the network and nothing else: a features extractor runs all of it, and what
stable-baselines3 puts behind an extractor only picks logits and value out of its answer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, cast

import torch
from sb3_contrib.common.maskable.policies import MaskableActorCriticPolicy
from stable_baselines3.common.torch_layers import BaseFeaturesExtractor
from torch import Tensor, nn

from vertifleet.torch import Gcaps, Mlp, Twin

if TYPE_CHECKING:
    from gymnasium import spaces
    from stable_baselines3.common.type_aliases import Schedule


class TwinExtractor(BaseFeaturesExtractor):
    """Logits and value of a network: [B, N + 1].

    Args:
        observation_space: what an environment shows.
        kind: the network.
        sizes: of its layers; those of the weight files that come with the program where none are given.
    """

    def __init__(self, observation_space: spaces.Dict, kind: type[Gcaps] | type[Mlp], **sizes: int) -> None:
        (vertiports,) = cast("tuple[int]", observation_space["action_mask"].shape)
        super().__init__(observation_space, features_dim=vertiports + 1)
        self.twin = kind(vertiports, **sizes)

    def forward(self, observations: dict[str, Tensor]) -> Tensor:
        """Logits and value; MaskablePPO asks the environment for the mask, and applies it later."""
        logits, values = self.twin(observations["nodes"], observations["aircraft"], observations["clock"])
        return torch.cat([logits, values.unsqueeze(-1)], dim=-1)


class Logits(nn.Module):
    """All but the last of an extractor's answers."""

    def forward(self, answers: Tensor) -> Tensor:
        """[B, N + 1] -> [B, N]."""
        return answers[:, :-1]


class Value(nn.Module):
    """The last of an extractor's answers."""

    def forward(self, answers: Tensor) -> Tensor:
        """[B, N + 1] -> [B, 1]."""
        return answers[:, -1:]


class TwinPolicy(MaskableActorCriticPolicy):
    """A network as the policy, first weights and all.

    Sizes of its layers are given as ``policy_kwargs={"features_extractor_kwargs": {"width": 64}}``.
    """

    kind: ClassVar[type[Gcaps] | type[Mlp]]

    def __init__(
        self,
        observation_space: spaces.Dict,
        action_space: spaces.Discrete[Any],
        lr_schedule: Schedule,
        **settings: Any,
    ) -> None:
        sizes = settings.get("features_extractor_kwargs") or {}
        fixed: dict[str, Any] = {
            "net_arch": [],
            "ortho_init": False,
            "share_features_extractor": True,
            "features_extractor_class": TwinExtractor,
            "features_extractor_kwargs": sizes | {"kind": self.kind},
        }
        super().__init__(observation_space, action_space, lr_schedule, **settings | fixed)

    def _build(self, lr_schedule: Schedule) -> None:
        """As the parent's, without its layers behind the extractor and their first weights."""
        self._build_mlp_extractor()
        self.action_net = Logits()
        self.value_net = Value()  # type: ignore[assignment]  # the parent's has weights
        settings = {"lr": lr_schedule(1), **self.optimizer_kwargs}
        self.optimizer = self.optimizer_class(self.parameters(), **settings)

    @property
    def twin(self) -> Twin:
        """The network that is trained."""
        return cast("TwinExtractor", self.features_extractor).twin


class GcapsPolicy(TwinPolicy):
    """The paper's network."""

    kind = Gcaps


class MlpPolicy(TwinPolicy):
    """The paper's baseline."""

    kind = Mlp
