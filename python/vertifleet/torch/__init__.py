"""The program's networks in PyTorch: the same layers and tensors, and weight files in both directions.

Weights that the program trained can be loaded, to inspect them or to train them further. Weights that were
trained here, perhaps on a GPU, can be saved, and the program decides with them::

    from vertifleet.torch import act, load, save

    twin = load("models/paper/gcaps.safetensors")
    choice = act(twin, observation)
    save(twin, "mine.safetensors")
"""

from vertifleet.torch.acting import act, masked, scores
from vertifleet.torch.decisions import Decisions
from vertifleet.torch.gcaps import Gcaps, GcapsFull, GcapsX
from vertifleet.torch.graph import Graph
from vertifleet.torch.mlp import Mlp, MlpFull
from vertifleet.torch.twin import Twin
from vertifleet.torch.weights import load, save

__all__ = [
    "Decisions",
    "Gcaps",
    "GcapsFull",
    "GcapsX",
    "Graph",
    "Mlp",
    "MlpFull",
    "Twin",
    "act",
    "load",
    "masked",
    "save",
    "scores",
]
