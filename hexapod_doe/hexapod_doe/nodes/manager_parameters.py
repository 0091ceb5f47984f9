# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the manager."""

from hexapod_node.parameters import Parameter

PARAMETERS = (
    Parameter('plan', '', 'plan.csv of the campaign; its bags lie beside it, under runs/'),
    Parameter(
        'episodes',
        0,
        'episodes of a training; 0: `training.episodes` of the specification',
        range=(0, 1_000_000),
    ),
    Parameter(
        'config', '', "file of changes to the specification of the plan's runs; empty for none"
    ),
    Parameter('set', [''], "further changes, each as 'key=value'"),
    Parameter(
        'record_every',
        100,
        'every how many episodes all topics are recorded; 0 for never',
        range=(0, 1_000_000),
    ),
    Parameter(
        'local_workers', -1, 'workers to start on this machine; -1: one per core', range=(-1, 256)
    ),
    Parameter(
        'worker_command',
        'ros2 run hexapod_bringup worker_node --ros-args -r __ns:=/{name} {files}',
        'what starts a local worker; {name} stands for its namespace, {files} for the parameters '
        'that let it use the folder of the campaign',
    ),
    Parameter(
        'worker_timeout',
        60.0,
        'longest wait for a worker while there is none',
        unit='s',
        range=(1.0, 86400.0),
    ),
    Parameter(
        'stall_timeout',
        60.0,
        'longest time without a sign of life of a worker, before its row goes to another',
        unit='s',
        range=(2.0, 86400.0),
    ),
    Parameter('attempts', 3, 'how often a failing row is tried', range=(1, 100)),
    Parameter(
        'stop_when',
        0.0,
        'expected loss of the choice, in units of the response, below which no new run is begun; '
        'asked after each round of as many runs as there are cases, from the third on; 0: never',
        range=(0.0, 1e9),
    ),
    Parameter('go_on', False, 'whether to go on with a campaign that its rule has ended'),
)
