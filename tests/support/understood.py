# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a program of ours takes the words that a page gives it; it is not carried out."""

import argparse
import re
import runpy
import subprocess
import sys
from collections.abc import Callable, Sequence
from pkgutil import resolve_name
from typing import Any
from unittest import mock

from hexapod_agent.specification.run_spec import RunSpec
from page_commands import ROOT
from ros2_mini.cli import build_parser
from ros2_mini.errors import CommandError
from ros2_mini.launch.arguments import declarations, parse_launch_arguments
from ros2_mini.packages import find_in_share

_ROS_ARGS = '--ros-args'
_WITH_OPTIONS = {'watch': 'hexapod_bringup.watch:main'}
"""Nodes that have options of their own, before those of ROS."""
_NODES = 'nodes.executables', 'hexapod_bringup.executables'


class _Parsed(BaseException):
    """Ends a program once its words are parsed; no program catches it."""


class NotUnderstoodError(ValueError):
    """A program does not take what a page gives it."""


def check(words: Sequence[str]) -> None:
    """Hold a command against the program that it calls.

    Raises:
        NotUnderstoodError: There is no such program, option, argument, parameter or target.
    """
    program, *given = words
    try:
        _CHECKS[program](given)
    except SystemExit as error:
        raise NotUnderstoodError(f'{" ".join(words)}: ends with {error.code}') from error
    except (ValueError, LookupError, OSError, CommandError) as error:
        raise NotUnderstoodError(f'{" ".join(words)}: {error}') from error


def console_main(package: str, executable: str) -> str:
    """Return `module:function` of an executable of a package.

    Raises:
        LookupError: It has none of that name.
    """
    setup = ROOT / 'ros_ws' / 'src' / package / 'setup.py'
    found = re.search(rf"'{executable} = ([\w.]+:\w+)'", setup.read_text(encoding='utf-8'))
    if not found:
        raise LookupError(f'{package} has no {executable}')
    return found[1]


def _ros2(given: Sequence[str]) -> None:
    if given[0] == 'security':  # of sros2, which the wheels lack
        return
    args = build_parser(given).parse_args(given)
    if given[0] == 'launch':
        _launch(args.package_name, args.launch_file_name, args.launch_arguments)
    if given[0] == 'run':
        _run(*given[1:])


def _launch(package: str, file: str, given: Sequence[str]) -> None:
    declared = {declaration.name for declaration in declarations(find_in_share(package, file))}
    arguments = parse_launch_arguments(given)
    if unknown := arguments.keys() - declared:
        raise LookupError(f'no argument {", ".join(unknown)}')
    if 'set' in arguments:
        RunSpec.load(None, arguments['set'].strip('[]').split(','))


def _run(package: str, executable: str, *given: str) -> None:
    target = _WITH_OPTIONS.get(executable) or console_main(package, executable)
    if any(name in target for name in _NODES):
        _node(executable, given)
    else:
        _main(lambda: resolve_name(target)(list(given)))


def _node(executable: str, given: Sequence[str]) -> None:
    """Check remappings and parameters of a node; docs/interfaces.md, itself tested, has these."""
    if not given:
        return
    if given[0] != _ROS_ARGS:
        raise ValueError(f'expected {_ROS_ARGS}')
    page = (ROOT / 'docs' / 'interfaces.md').read_text(encoding='utf-8')
    parts = [part for part in re.split(r'^## ', page, flags=re.M) if f' {executable}`\n' in part]
    known = set(re.findall(r'^\| `([\w.]+)` \|', ''.join(parts) or page, re.M)) | {'use_sim_time'}
    rest = list(given[1:])
    while rest:
        option, value = rest.pop(0), rest.pop(0)
        if option == '--enclave':
            continue
        name, separator, _ = value.partition(':=')
        if not separator or option not in ('-p', '-r'):
            raise ValueError(f'{option} {value}')
        if option == '-p' and name not in known:
            raise LookupError(f'no parameter {name}')


def _main(run: Callable[[], object]) -> None:
    """Let a program parse its words, and check the keys of specifications among them."""

    def parse(self: argparse.ArgumentParser, args: Any = None, namespace: Any = None) -> None:
        parsed, odd = self.parse_known_args(args, namespace)
        if odd:
            self.error(f'unrecognized arguments: {" ".join(odd)}')
        _check_keys(parsed)  # here, while a program that lends an algorithm still does
        raise _Parsed

    with mock.patch.object(argparse.ArgumentParser, 'parse_args', parse):
        try:
            run()
        except _Parsed:
            return
    raise ValueError('nothing was parsed')


def _check_keys(options: argparse.Namespace) -> None:
    """Check the keys of a specification among the options of a program."""
    grid = [setting.split(',')[0] for setting in getattr(options, 'grid', None) or ()]
    cells = [
        one for cell in getattr(options, 'cell', None) or () for one in cell.split(',') if one
    ]
    RunSpec.load(None, [*(getattr(options, 'set', None) or ()), *map(str, grid), *cells])


def _python(given: Sequence[str]) -> None:
    if given[0] == '-m' and given[1] in ('pytest', 'colcon', 'venv', 'pip'):
        return
    if given[0] == '-m':
        module, *words = given[1:]
        _main(lambda: resolve_name(f'{module}:main')(words))
        return
    file, *words = given
    path = ROOT / file
    if words and words[0] != _ROS_ARGS:  # a node takes any of these
        found = [str(path.parent), *sys.path]
        with mock.patch.multiple(sys, argv=[str(path), *words], path=found):
            _main(lambda: runpy.run_path(str(path), run_name='__main__'))
    elif not path.is_file():
        raise LookupError(f'there is no {file}')


def _make(given: Sequence[str]) -> None:
    targets = [word for word in given if '=' not in word]
    told = subprocess.run(
        ['make', '-n', '-C', str(ROOT), '-q', '-p', '--no-builtin-rules', 'help'],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    known = set(re.findall(r'^([\w./-]+):', told.stdout, re.M))
    if unknown := set(targets) - known:
        raise LookupError(f'no target {", ".join(unknown)}')


_CHECKS: dict[str, Callable[[Sequence[str]], None]] = {
    'ros2': _ros2,
    'make': _make,
    'python': _python,
}
