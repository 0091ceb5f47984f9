# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A layout of Foxglove: the robot in 3D, the nodes' health, and the plots in tabs."""

import json
from typing import Any

from hexapod_sim.robot import BASE_FRAME, JOINTS, ODOM_FRAME

from hexapod_bringup.layouts.plots import Curve, Plot, prefix, tabs

Json = dict[str, Any]


def foxglove(namespace: str) -> str:
    """Return the layout as JSON, for the nodes of a namespace."""
    start = prefix(namespace)
    panels: Json = {'3D!robot': _scene(start), 'DiagnosticSummary!health': _health()}
    shown = []
    for name, plots in tabs().items():
        keys = [f'Plot!{name}{number}' for number in range(len(plots))]
        panels |= {key: _plot(plot, start) for key, plot in zip(keys, plots, strict=True)}
        shown.append({'title': name, 'layout': _stacked(keys)})
    panels['Tab!plots'] = {'activeTabIdx': 0, 'tabs': shown}
    left = _split('3D!robot', 'DiagnosticSummary!health', 'column', 75)
    layout = {
        'configById': panels,
        'globalVariables': {},
        'userNodes': {},
        'playbackConfig': {'speed': 1.0},
        'layout': _split(left, 'Tab!plots', 'row', 50),
    }
    return f'{json.dumps(layout, indent=2)}\n'


def _scene(start: str) -> Json:
    robot = {
        'layerId': 'foxglove.Urdf',
        'instanceId': 'robot',
        'label': 'robot',
        'visible': True,
        'frameLocked': True,
        'sourceType': 'topic',
        'topic': f'{start}robot_description',
        'framePrefix': '',
        'displayMode': 'visual',
        # The joints move where nobody publishes tf, too.
        'controlMode': 'jointStates',
        'jointStatesTopic': f'{start}joint_states',
    }
    floor = {
        'layerId': 'foxglove.Grid',
        'instanceId': 'floor',
        'label': 'floor',
        'visible': True,
        'frameLocked': True,
        'frameId': ODOM_FRAME,
        'size': 20,
        'divisions': 20,
    }
    shown = ('joint_states', 'odom', 'tf', 'tf_static')
    return {
        'followTf': BASE_FRAME,
        'followMode': 'follow-position',
        'cameraState': {'distance': 1.2, 'perspective': True, 'phi': 60, 'thetaOffset': 45},
        'layers': {'robot': robot, 'floor': floor},
        'topics': {f'{start}{topic}': {'visible': True} for topic in shown},
    }


def _health() -> Json:
    return {'topicToRender': '/diagnostics', 'minLevel': 0, 'sortByLevel': True}


def _plot(plot: Plot, start: str) -> Json:
    paths = [
        {
            'value': f'{start}{curve.topic}.{curve.field}{_index(curve)}',
            'label': curve.label,
            'enabled': True,
            # The time of a lock-step graph, and of its bags, is simulated.
            'timestampMethod': 'headerStamp',
        }
        for curve in plot.curves
    ]
    return {
        'title': plot.title,
        'foxglovePanelTitle': plot.title,
        'xAxisVal': 'timestamp',
        'showLegend': True,
        'paths': paths,
    }


def _index(curve: Curve) -> str:
    """Return the index of an array's element; message paths know no joints, only their order."""
    index = JOINTS.index(curve.joint) if curve.joint else curve.index
    return '' if index is None else f'[{index}]'


def _stacked(keys: list[str]) -> Any:
    """Put panels of one height below each other."""
    if len(keys) == 1:
        return keys[0]
    return _split(keys[0], _stacked(keys[1:]), 'column', round(100 / len(keys)))


def _split(first: Any, second: Any, direction: str, percentage: int) -> Json:
    return {
        'first': first,
        'second': second,
        'direction': direction,
        'splitPercentage': percentage,
    }
