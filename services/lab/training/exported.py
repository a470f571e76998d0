# SPDX-License-Identifier: Apache-2.0
"""Reads the weights of a network that export.py has written, to train it further."""
import numpy as np
import onnx
import torch
from onnx import numpy_helper
from torch import nn


def convolutions(file):
    """-> {module name: (weight, bias)} of every convolution."""
    graph = onnx.load(str(file)).graph
    values = {value.name: torch.from_numpy(np.array(numpy_helper.to_array(value))) for value in graph.initializer}
    found = {}
    for node in graph.node:
        if node.op_type == "Conv":
            name = node.output[0].removesuffix("/Conv_output_0").strip("/").replace("/", ".")
            found[name if node.output[0] != "maps" else "out"] = tuple(values[name] for name in node.input[1:])
    return found


def parts_of(name):
    """An exported name repeats the name of each level: block1.first.first.0 is the module block1.first.0."""
    parts = name.split(".")
    return [part for i, part in enumerate(parts) if i == 0 or part != parts[i - 1]]


@torch.no_grad()
def start_from(network, file, image, maps):
    """Gives `network` the weights of `file`. The file has no normalisations: those of the network get the statistics of these inputs,
    some hundred images, and weights that undo them."""
    hooks = []
    for name, (weight, bias) in convolutions(file).items():
        module = network.get_submodule(".".join(parts_of(name)))
        module.weight.copy_(weight)
        if module.bias is not None:
            module.bias.copy_(bias)
            continue
        after = network.get_submodule(".".join(parts_of(name)[:-1]))[1]
        assert isinstance(after, nn.BatchNorm2d)

        def set_statistics(layer, inputs, bias=bias):
            layer.running_var, layer.running_mean = torch.var_mean(inputs[0], (0, 2, 3), unbiased=False)
            layer.weight.copy_((layer.running_var + layer.eps).sqrt())
            layer.bias.copy_(bias + layer.running_mean)

        hooks.append(after.register_forward_pre_hook(set_statistics))
    network.eval()
    network(image, maps)
    for hook in hooks:
        hook.remove()
