# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What every command line shares: declared ranges, one line for a fault, any terminal, `~`.

It stands in the package that all others build on.
"""

import argparse
import dataclasses
import io
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import NoneType
from typing import Annotated, Any, NoReturn, TypeVar, get_args, get_origin, get_type_hints

from annotated_types import Interval

MOST_EPISODES = 10_000_000
MOST_SEED = 2**63 - 1
_T = TypeVar('_T', int, float)
_WIDEST = Interval()


class CommandLine(argparse.ArgumentParser):
    """A parser that tells a fault in one line, with status 2, on a terminal of any encoding."""

    def parse_known_args(  # type: ignore[override]  # of many overloads
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        """Parse the words; from here on no letter is too strange for the terminal."""
        suit_any_terminal()
        return super().parse_known_args(args, namespace)

    def error(self, message: str) -> NoReturn:
        """End the process."""
        self.exit(2, f'{self.prog}: error: {" ".join(message.split())}\n')


def suit_any_terminal() -> None:
    """Write letters that the terminal's encoding lacks as escapes, as Python does in errors."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors='backslashreplace')


def one_line(error: Exception) -> str:
    """Return what an error says in one line; of the system's with the file that it is about."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        return f'{error.filename}: {error.strerror[0].lower()}{error.strerror[1:]}'
    return ' '.join(str(error).split())


def number(
    ge: float | None = None, le: float | None = None, *, gt: float | None = None,
    lt: float | None = None,
) -> Callable[[str], float]:  # fmt: skip
    """Return the type of an option that takes a finite number of a range."""
    return _within(float, Interval(ge=ge, gt=gt, le=le, lt=lt))


def whole(ge: int | None = None, le: int | None = None) -> Callable[[str], int]:
    """Return the type of an option that takes a whole number of a range, its ends included."""
    return _within(int, Interval(ge=ge, le=le))


def path(text: str) -> Path:
    """Return a path; `~` is the home folder.

    Raises:
        argparse.ArgumentTypeError: It is empty, or nobody knows that home.
    """
    if not text:
        raise argparse.ArgumentTypeError("'', expected a path")
    try:
        return Path(text).expanduser()
    except RuntimeError as error:
        raise argparse.ArgumentTypeError(f'{text!r}: {error}') from error


def folder(text: str) -> Path:
    """Return the path of a folder, which need not be there yet.

    Raises:
        argparse.ArgumentTypeError: It is a file.
    """
    found = path(text)
    if found.exists() and not found.is_dir():
        raise argparse.ArgumentTypeError(f'{text!r} is a file, expected a folder')
    return found


def file(text: str) -> Path:
    """Return the path of a file, which need not be there yet.

    Raises:
        argparse.ArgumentTypeError: It is a folder.
    """
    found = path(text)
    if found.is_dir():
        raise argparse.ArgumentTypeError(f'{text!r} is a folder, expected the name of a file')
    return found


def output_file(*endings: str) -> Callable[[str], Path]:
    """Return the type of a file to write, in a folder that is there.

    Args:
        *endings: How its name may end; none for any.
    """

    def parse(text: str) -> Path:
        found = file(text)
        if endings and found.suffix.lower() not in endings:
            raise argparse.ArgumentTypeError(
                f'{text!r}, expected a name that ends in {" or ".join(endings)}'
            )
        if not found.parent.is_dir():
            raise argparse.ArgumentTypeError(
                f'{text!r}: there is no folder {str(found.parent)!r}, expected an existing one'
            )
        return found

    return parse


def _within(kind: Callable[[str], _T], interval: Interval) -> Callable[[str], _T]:
    def parse(text: str) -> _T:
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not _holds(interval, value):
            raise argparse.ArgumentTypeError(f'{text!r}, expected {_range(kind, interval, value)}')
        return value

    return parse


def _holds(interval: Interval, value: Any) -> bool:
    return (
        math.isfinite(value)
        and (interval.ge is None or value >= interval.ge)
        and (interval.gt is None or value > interval.gt)
        and (interval.le is None or value <= interval.le)
        and (interval.lt is None or value < interval.lt)
    )


def _range(kind: object, interval: Interval, value: Any = None) -> str:
    """Return what an option expects, in words; of a percentage also the share that it is."""
    noun = 'a whole number' if kind is int else 'a number'
    if interval == Interval(gt=0):
        return noun.replace('a ', 'a positive ', 1)
    if interval.ge is not None and interval.le is not None:
        return f'{noun} from {interval.ge} to {interval.le}'
    limits = (
        ('at least', interval.ge),
        ('above', interval.gt),
        ('at most', interval.le),
        ('below', interval.lt),
    )
    shown = ' and '.join(f'{word} {limit:g}' for word, limit in limits if limit is not None)
    if not shown:
        return noun if kind is int else f'{noun}, neither nan nor inf'
    if interval == Interval(gt=0, lt=1) and value is not None and 1 < value < 100:
        return f'{noun} {shown}: {value:g} % is {value / 100:g}'
    return f'{shown}, {noun}' if kind is int else f'{noun} {shown}'


@dataclasses.dataclass(frozen=True)
class Option:
    """How a field of a dataclass appears on the command line, beside its range."""

    help: str
    metavar: str | None = None
    parse: Callable[[str], Any] | None = None
    """Reads a text that is neither a number nor a path."""


def add_options(
    parser: argparse._ActionsContainer, declaration: type, names: Iterable[str]
) -> None:
    """Add the options that fields of a dataclass declare.

    A field's type is `Annotated[int, Interval(ge=1), Option('what it is')]`, where the interval
    may be missing.

    Args:
        parser: Parser, or group of one.
        declaration: The dataclass; its defaults are those of the options.
        names: Which fields.
    """
    fields = {field.name: field for field in dataclasses.fields(declaration)}
    for name in names:
        kind, interval, option = _declared(declaration)[name]
        shape: dict[str, Any] = {'metavar': option.metavar, 'type': option.parse or kind}
        if kind is bool:
            off = fields[name].default is False
            action = 'store_true' if off else argparse.BooleanOptionalAction
            shape = {'action': action}
        elif kind in (int, float):
            shape['type'] = _within(kind, interval)
        elif kind is Path:
            shape['type'] = file
        parser.add_argument(
            f'--{name.replace("_", "-")}', default=fields[name].default, help=option.help, **shape
        )


def options_of(declaration: type, args: argparse.Namespace) -> dict[str, Any]:
    """Return the values of a dataclass's declared options that a command line has."""
    return {name: getattr(args, name) for name in _declared(declaration) if name in args}


def range_fault(values: Any) -> str:
    """Return which field of a dataclass lies outside its declared range; empty if none does."""
    for name, (kind, interval, _) in _declared(type(values)).items():
        value = getattr(values, name)
        if kind in (int, float) and value is not None and not _holds(interval, value):
            return f'{name} {value}: expected {_range(kind, interval, value)}'
    return ''


def _declared(declaration: type) -> Mapping[str, tuple[Any, Interval, Option]]:
    """Return type, range and option of the fields that have one."""
    found = {}
    for name, hint in get_type_hints(declaration, include_extras=True).items():
        if get_origin(hint) is not Annotated:
            continue
        inner, *marks = get_args(hint)
        kinds = [kind for kind in get_args(inner) or (inner,) if kind is not NoneType]
        options = [mark for mark in marks if isinstance(mark, Option)]
        intervals = [mark for mark in marks if isinstance(mark, Interval)]
        if options:
            found[name] = (kinds[0], (intervals or [_WIDEST])[0], options[0])
    return found
