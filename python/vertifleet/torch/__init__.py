"""The program's networks in PyTorch: the same layers, the same tensors, weight files both ways.

Weights that the program trained are loaded to be looked at or trained further; weights that were trained
here, on a GPU perhaps, are saved, and the program decides with them::

    from vertifleet.torch import act, load, save

    twin = load("models/paper/gcaps.safetensors")
    choice = act(twin, observation)
    save(twin, "mine.safetensors")
"""

from vertifleet.torch.acting import act, masked
from vertifleet.torch.gcaps import Gcaps, GcapsX
from vertifleet.torch.mlp import Mlp
from vertifleet.torch.twin import Twin
from vertifleet.torch.weights import load, save

__all__ = ["Gcaps", "GcapsX", "Mlp", "Twin", "act", "load", "masked", "save"]
