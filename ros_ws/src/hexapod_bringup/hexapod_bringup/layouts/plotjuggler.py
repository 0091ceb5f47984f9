# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A layout of PlotJuggler: the plots in tabs."""

from xml.etree import ElementTree

from hexapod_bringup.layouts.plots import Curve, Plot, prefix, tabs

_COLOURS = ('#1f77b4', '#d62728', '#2ca02c', '#ff7f0e', '#9467bd', '#17becf')


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
        name = f'{start}{curve.topic}/{_path(curve)}'
        ElementTree.SubElement(element, 'curve', name=name, color=colour)


def _path(curve: Curve) -> str:
    """Return a curve's name below its topic, as the ROS 2 parsers of PlotJuggler make it."""
    if curve.joint:
        return f'{curve.joint}/{curve.field}'
    index = '' if curve.index is None else f'[{curve.index}]'
    return f'{curve.field.replace(".", "/")}{index}'
