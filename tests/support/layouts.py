# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Makes the layouts of Foxglove and PlotJuggler that hexapod_bringup ships, of one table of plots.

`python tests/support/layouts.py` writes them; a test holds them to it.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from hexapod_agent.learning import metrics
from hexapod_bringup.layout import FILES, NAMESPACE
from hexapod_sim.robot import BASE_FRAME, JOINTS, LEG_JOINTS, LEGS, ODOM_FRAME

SHIPPED = Path(__file__).resolve().parents[2] / 'ros_ws/src/hexapod_bringup/layouts'
Json = dict[str, Any]
_COLOURS = ('#1f77b4', '#d62728', '#2ca02c', '#ff7f0e', '#9467bd', '#17becf')


@dataclass(frozen=True)
class Curve:
    """One number of a topic over time.

    Attributes:
        topic: relative name.
        label: in the legend.
        field: of the message, with dots down to the number or to an array.
        index: in the array, where it is one.
        joint: whose element of the array is meant, in a joint state.
    """

    topic: str
    label: str
    field: str
    index: int | None = None
    joint: str = ''


@dataclass(frozen=True)
class Plot:
    """Curves that share axes."""

    title: str
    curves: tuple[Curve, ...]


def _legs(topic: str, field: str) -> tuple[Curve, ...]:
    return tuple(Curve(topic, leg, field, index) for index, leg in enumerate(LEGS))


def _joints(joint: str) -> tuple[Curve, ...]:
    return tuple(Curve('joint_states', leg, 'position', joint=f'{leg}_{joint}') for leg in LEGS)


_TABS: dict[str, tuple[Plot, ...]] = {
    'task': (
        Plot('offset from the line (m)', (Curve('line_offset', 'offset', 'offset'),)),
        Plot('reward', (Curve('step_outcome', 'reward', 'reward'),)),
        Plot(
            'velocity of the body (m/s)',
            tuple(Curve('body/twist', axis, f'twist.linear.{axis}') for axis in 'xyz'),
        ),
        Plot('height (m)', (Curve('body/height', 'range finder', 'range'),)),
    ),
    'joints': tuple(Plot(f'{joint} angles (rad)', _joints(joint)) for joint in LEG_JOINTS),
    'gait': (
        Plot('oscillators, x', _legs('cpg/state', 'x')),
        Plot('hip gain asked (rad)', _legs('cpg/command', 'hip_gain')),
        Plot('feet on the floor', _legs('foot_contacts', 'contact')),
        Plot(
            'vertical foot forces (N)',
            tuple(Curve(f'foot_force/{leg}', leg, 'wrench.force.z') for leg in LEGS),
        ),
    ),
    'learning': (
        Plot(
            'return of the episodes',
            (
                Curve('episode_result', 'return', 'episode_return'),
                Curve('episode_result', 'average', 'average_return'),
            ),
        ),
    ),
}


def tabs() -> dict[str, tuple[Plot, ...]]:
    """Return the plots by tab, those of the learner's metrics among them."""
    return _TABS | {'learning': (*_TABS['learning'], *_metric_plots())}


def _metric_plots() -> Iterator[Plot]:
    curves: dict[str, list[Curve]] = {}
    for index, metric in enumerate(metrics.METRICS):
        if metric.plot:
            curve = Curve('episode_result', metric.name, 'metric_values', index)
            curves.setdefault(metric.plot, []).append(curve)
    return (Plot(title, tuple(of_plot)) for title, of_plot in curves.items())


def prefix(namespace: str) -> str:
    """Return what goes in front of the relative names of a namespace."""
    name = namespace.strip('/')
    return f'/{name}/' if name else '/'


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


def plotjuggler(namespace: str) -> str:
    """Return the layout as XML, for the nodes of a namespace."""
    root = ElementTree.Element('root')
    window = {'parent': 'main_window', 'name': 'Main Window'}
    widget = ElementTree.SubElement(root, 'tabbed_widget', window)
    for name, plots in tabs().items():
        tab = ElementTree.SubElement(widget, 'Tab', tab_name=name, containers='1')
        container = ElementTree.SubElement(tab, 'Container')
        sizes = ';'.join([f'{1 / len(plots):.6f}'] * len(plots))
        splitter = ElementTree.SubElement(
            container, 'DockSplitter', orientation='-', sizes=sizes, count=str(len(plots))
        )
        for plot in plots:
            _add_plot(splitter, plot, prefix(namespace))
    ElementTree.SubElement(widget, 'currentTabIndex', index='0')
    ElementTree.SubElement(root, 'use_relative_time_offset', enabled='1')
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding='unicode')
    return f"<?xml version='1.0' encoding='UTF-8'?>\n{text}\n"


def _add_plot(splitter: ElementTree.Element, plot: Plot, start: str) -> None:
    area = ElementTree.SubElement(splitter, 'DockArea', name=plot.title)
    element = ElementTree.SubElement(area, 'plot', mode='TimeSeries', style='Lines')
    ElementTree.SubElement(element, 'limitY')
    for curve, colour in zip(plot.curves, _COLOURS, strict=False):
        name = f'{start}{curve.topic}/{_name_below(curve)}'
        ElementTree.SubElement(element, 'curve', name=name, color=colour)


def _name_below(curve: Curve) -> str:
    """Return a curve's name below its topic, as the ROS 2 parsers of PlotJuggler make it."""
    if curve.joint:
        return f'{curve.joint}/{curve.field}'
    index = '' if curve.index is None else f'[{curve.index}]'
    return f'{curve.field.replace(".", "/")}{index}'


MAKERS = {'foxglove': foxglove, 'plotjuggler': plotjuggler}


def main() -> None:
    """Write both."""
    for program, make in MAKERS.items():
        (SHIPPED / FILES[program]).write_text(make(NAMESPACE), encoding='utf-8')


if __name__ == '__main__':
    main()
