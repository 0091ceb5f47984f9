# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `export`: a checkpoint's policy as ONNX, from readings in SI units to the action.

The file needs nothing of this project to run: it normalises the readings itself, and its metadata
is the contract of what to feed in and what comes out.
"""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import onnx
from hexapod_cpg.mapping import ACTION_SIZE
from hexapod_sim.command_line import CommandLine, file, output_file
from hexapod_sim.robot import CONTROL_PERIOD_NS, JOINTS, LEGS
from hexapod_sim.sensor_table import PREVIOUS_ACTION
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

from hexapod_agent.algorithms.policies import MlpPolicy
from hexapod_agent.deployment import agent_file
from hexapod_agent.deployment.agent_file import TrainedAgent
from hexapod_agent.specification.observation import ObservationSpec

_OPSET = 17
_IR_VERSION = 8  # the opset's own; newer ones shut out older runtimes
_ACTION = 'action'
_BATCH = 'batch'


def main(args: Sequence[str] | None = None) -> None:
    """Write the file that the command line names."""
    parser = CommandLine(prog='export', description=__doc__)
    parser.add_argument('checkpoint', type=file, help='file of train')
    parser.add_argument('out', type=output_file(), help='ONNX file to write')
    options = parser.parse_args(args)
    try:
        agent = agent_file.load(options.checkpoint)
        onnx.save(policy_model(agent), options.out)
    except (OSError, agent_file.CheckpointError) as error:
        parser.error(str(error))
    print(f'{options.out}: action from {", ".join(agent.spec.sizes)}')


def policy_model(agent: TrainedAgent) -> onnx.ModelProto:
    """Return the noise-free policy as a model.

    Inputs are one array (batch, size) float64 per reading, by its key in the sensor table, and
    `previous_action`; the output `action` is (batch, 30) float32, within +-1. The observation is
    made in float64 and rounded once, as `ObservationSpec.assemble` does.
    """
    spec, policy = agent.spec, agent.policy
    constants = {
        'center': spec.center, 'scale': spec.scale,
        'lowest': np.array(-1.0), 'highest': np.array(1.0),
    }  # fmt: skip
    nodes = [
        helper.make_node('Concat', list(spec.sizes), ['readings'], axis=1),
        helper.make_node('Sub', ['readings', 'center'], ['deviation']),
        helper.make_node('Div', ['deviation', 'scale'], ['scaled']),
        helper.make_node('Clip', ['scaled', 'lowest', 'highest'], ['clipped']),
        helper.make_node('Cast', ['clipped'], ['observation'], to=TensorProto.FLOAT),
    ]
    layers, weights = _layers('observation', policy)
    graph = helper.make_graph(
        [*nodes, *layers],
        'hexapod_policy',
        [
            helper.make_tensor_value_info(key, TensorProto.DOUBLE, [_BATCH, size])
            for key, size in spec.sizes.items()
        ],
        [helper.make_tensor_value_info(_ACTION, TensorProto.FLOAT, [_BATCH, ACTION_SIZE])],
        [numpy_helper.from_array(value, name) for name, value in (constants | weights).items()],
    )
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid('', _OPSET)], ir_version=_IR_VERSION,
        producer_name='hexapod_agent', doc_string='Policy of a hexapod that follows a line.',
    )  # fmt: skip
    helper.set_model_props(model, contract(agent))
    onnx.checker.check_model(model, full_check=True)
    return model


def _layers(
    x: str, policy: MlpPolicy
) -> tuple[list[onnx.NodeProto], dict[str, NDArray[np.float32]]]:
    """Affine layers with ReLU between them, and +-1 at the end."""
    nodes, constants = [], dict[str, NDArray[np.float32]]()
    for number, (weight, bias) in enumerate(policy.layers):
        name, last = f'layer{number}', number == len(policy.layers) - 1
        arrays = {f'{name}.weight': weight, f'{name}.bias': bias}
        nodes.append(helper.make_node('Gemm', [x, *arrays], [f'{name}.sum'], transB=1))
        x = f'{name}.sum'
        constants |= arrays
        if not last:
            nodes.append(helper.make_node('Relu', [x], [f'{name}.output']))
            x = f'{name}.output'
    if policy.squash:
        return [*nodes, helper.make_node('Tanh', [x], [_ACTION])], constants
    bounds = {'action.least': np.array(-1.0, np.float32), 'action.most': np.array(1.0, np.float32)}
    return [*nodes, helper.make_node('Clip', [x, *bounds], [_ACTION])], constants | bounds


def contract(agent: TrainedAgent) -> dict[str, str]:
    """Return what a user of the model must know, as its metadata; values are JSON."""
    cpg = agent.config.cpg
    content: dict[str, Any] = {
        'observations': agent.spec.letters,
        'inputs': inputs_of(agent.spec),
        'action': {
            'layout': 'leg-major: five numbers of each leg in turn',
            'legs': LEGS,
            'reading': cpg.reading,
            'ranges': vars(cpg.ranges),
            'pattern_generator': vars(cpg.hopf),
        },
        'joints': JOINTS,
        'control_period_ns': CONTROL_PERIOD_NS,
        'seed': agent.seed,
        'episodes': agent.episode,
    }
    return {key: json.dumps(value, ensure_ascii=False) for key, value in content.items()}


def inputs_of(spec: ObservationSpec) -> list[dict[str, Any]]:
    """Return a row per input: where it comes from, its size, unit and normalisation."""
    rows = []
    for channel in spec.channels:
        for quantity in channel.quantities:
            key = quantity.name
            row = {
                'input': key, 'channel': channel.name, 'letter': channel.letter,
                'topics': channel.topics, 'message_type': channel.message_type,
                'size': quantity.size, 'unit': quantity.unit,
                'scale': quantity.scale, 'center': quantity.center,
            }  # fmt: skip
            if key == PREVIOUS_ACTION:
                row['first'] = 'zeros, until there is one'
            rows.append(row)
    return rows


if __name__ == '__main__':
    main()
