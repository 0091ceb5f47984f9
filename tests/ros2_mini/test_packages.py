# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

from ros2_mini.cli import main


def test_prefix(prefix, capsys):
    assert main(['pkg', 'prefix', 'demo']) == 0
    assert main(['pkg', 'prefix', '--share', 'demo']) == 0
    assert capsys.readouterr().out == f'{prefix.root}\n{prefix.share}\n'


def errors_of(words: list[str], capsys) -> str:
    assert main(words) == 1
    return capsys.readouterr().err


def test_missing_things_are_named(prefix, capsys):
    path = prefix.add_executable('talker', 'exit 0')
    (path.parent / 'notes.txt').touch()
    assert errors_of(['pkg', 'prefix', 'nope'], capsys) == "Package 'nope' not found\n"
    assert errors_of(['run', 'nope', 'x'], capsys) == "Package 'nope' not found\n"
    expected = "No executable found: package 'demo' has no 'x'; it has: talker\n"
    assert errors_of(['run', 'demo', 'x'], capsys) == expected
    message = errors_of(['launch', 'demo', 'x.launch.xml'], capsys)
    assert message.startswith("file 'x.launch.xml' was not found in the share directory of")
    expected = "launch file 'x.launch.xml' does not exist\n"
    assert errors_of(['launch', 'x.launch.xml'], capsys) == expected


def test_launch_file_found_twice(prefix, capsys):
    prefix.add_launch_file('', 'x.launch.xml')
    (prefix.share / 'deep').mkdir()
    prefix.add_launch_file('', 'deep/x.launch.xml')
    assert "file 'x.launch.xml' was found more than once" in errors_of(
        ['launch', 'demo', 'x.launch.xml'], capsys
    )


def test_executable_found_twice(prefix, capsys):
    path = prefix.add_executable('talker', 'exit 0')
    (path.parent / 'deep').mkdir()
    path.with_name('deep').joinpath('talker').hardlink_to(path)
    assert errors_of(['run', 'demo', 'talker'], capsys).startswith('Multiple executables found:\n')
