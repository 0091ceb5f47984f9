# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Every curve of the layouts is a number that a recorded run has."""

import json
import re
from functools import reduce
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hexapod_bringup.layout import FILES, NAMESPACE, main
from hexapod_doe.bags.bag_file import BagFile
from layouts import MAKERS, SHIPPED, foxglove, plotjuggler

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / 'bags' / 'sample'
NEWER = ROOT / 'bags' / 'sample_campaign' / 'runs' / 'case01_rep01'


@pytest.fixture(scope='module')
def recorded() -> dict[str, object]:
    """One message of each topic of the shipped bag."""
    bag = BagFile(SAMPLE)
    found = {topic: next(bag.decoded(topic))[1] for topic in bag.types if 'clock' not in topic}
    # That bag is of before metrics had names.
    newer = BagFile(NEWER)
    _, found['/hexapod/episode_result'] = next(newer.decoded(newer.result_topic()))
    return found


def number(message: object, path: str) -> float:
    """Follow a path such as `twist.linear.x` or `position[3]`."""
    words = re.findall(r'\w+', path)
    value = reduce(lambda v, w: v[int(w)] if w.isdigit() else getattr(v, w), words, message)
    return float(value)


def test_foxglove_plots_what_there_is(recorded) -> None:
    layout = json.loads(foxglove('hexapod'))
    panels = layout['configById']
    paths = [path for panel in panels.values() for path in panel.get('paths', ())]
    assert len(paths) > 40
    for path in paths:
        topic, field = path['value'].split('.', 1)
        number(recorded[topic], field)
    hip = next(p for p in panels['Plot!joints0']['paths'] if p['label'] == 'rf')
    index = int(re.search(r'\[(\d+)\]', hip['value']).group(1))
    assert recorded['/hexapod/joint_states'].name[index] == 'rf_hip'


def test_every_panel_of_foxglove_is_placed_once() -> None:
    layout = json.loads(foxglove('w'))
    tabs = layout['configById']['Tab!plots']['tabs']
    placed = []

    def place(tree: object) -> None:
        if isinstance(tree, str):
            placed.append(tree)
        else:
            place(tree['first'])
            place(tree['second'])

    for tree in (layout['layout'], *(tab['layout'] for tab in tabs)):
        place(tree)
    assert sorted(placed) == sorted(layout['configById'])
    robot = layout['configById']['3D!robot']['layers']['robot']
    assert robot['topic'] == '/w/robot_description'
    assert robot['jointStatesTopic'] == '/w/joint_states'


def test_plotjuggler_plots_what_there_is(recorded) -> None:
    root = ElementTree.fromstring(plotjuggler('/hexapod/'))
    names = [curve.get('name') for curve in root.iter('curve')]
    assert len(names) > 40
    for name in names:
        topic = max((t for t in recorded if name.startswith(f'{t}/')), key=len)
        path = name.removeprefix(f'{topic}/')
        if topic.endswith('joint_states'):
            joint, field = path.split('/')
            path = f'{field}[{recorded[topic].name.index(joint)}]'
        number(recorded[topic], path.replace('/', '.'))
    for splitter in root.iter('DockSplitter'):
        assert int(splitter.get('count')) == len(splitter)
        assert sum(map(float, splitter.get('sizes').split(';'))) == pytest.approx(1, abs=1e-4)


def test_both_show_the_same_curves() -> None:
    panels = json.loads(foxglove('w'))['configById'].values()
    drawn = [panel['title'] for panel in panels if 'paths' in panel]
    root = ElementTree.fromstring(plotjuggler('w'))
    assert drawn == [area.get('name') for area in root.iter('DockArea')]


@pytest.mark.parametrize('program', MAKERS)
def test_shipped_layouts_are_those_of_the_worker(program: str, tmp_path, capsys) -> None:
    main([program])
    made = MAKERS[program](NAMESPACE)
    assert capsys.readouterr().out == made, 'run python tests/support/layouts.py'
    assert (SHIPPED / FILES[program]).read_text(encoding='utf-8') == made
    launch = ElementTree.parse(SHIPPED.parent / 'launch' / 'worker.launch.xml')
    assert launch.find("arg[@name='namespace']").get('default') == NAMESPACE
    for namespace in ('', 'a/b'):
        main([program, '--namespace', namespace, '--out', str(tmp_path / 'layout')])
        assert (tmp_path / 'layout').read_text() == MAKERS[program](namespace)
