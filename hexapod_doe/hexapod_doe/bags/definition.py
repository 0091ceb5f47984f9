# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a topic's messages are of the type that is installed, by what the bag says of it.

Messages go over the wire without their field names: whoever reads them by another definition than
they were written by gets wrong numbers, or none, and no word of it.
"""

import re
from itertools import zip_longest

from hexapod_doe.bags.mcap_file import RecordedTopic
from hexapod_doe.bags.schema import definition, type_hash
from hexapod_doe.errors import BagError

Layout = dict[str, tuple[str, ...]]
"""Fields as 'type name' by type, for a type and all that it is made of."""
_PART = re.compile(r'^=+[ \t]*\r?\nMSG:[ \t]*(\S+)[ \t]*\r?$', re.MULTILINE)
_FIELD = re.compile(
    r'^(?P<base>[A-Za-z][\w/]*)(?P<bounds>\S*)\s+(?P<name>[A-Za-z]\w*)\s*(?P<mark>=?)'
)
_BUILT_IN = re.compile(r'^(bool|byte|char|float(32|64)|u?int(8|16|32|64)|w?string)$')
_SAME_ON_THE_WIRE = {'byte': 'uint8', 'char': 'uint8', 'Header': 'std_msgs/Header'}
_ROS2MSG = 'ros2msg'
_NO_HASH = re.compile(r'^(RIHS01_0*)?$')


def layout(type_name: str, text: str) -> Layout:
    """Return the fields of a type and of those that it is made of.

    Comments, constants and default values do not go over the wire, and are left out.

    Args:
        type_name: such as 'sensor_msgs/msg/Imu'.
        text: its definition, then those of its parts, as rosbag2 writes them.

    Raises:
        ValueError: a line is no field, or a part is not defined.
    """
    first, *rest = _PART.split(text)
    names = [_plain(type_name), *map(_plain, rest[::2])]
    texts = dict(zip(names, [first, *rest[1::2]], strict=True))
    found: Layout = {}
    waiting = [names[0]]
    while waiting:
        name = waiting.pop()
        if name not in found:
            if name not in texts:
                raise ValueError(f'no definition of {name}')
            found[name] = _fields(name, texts[name])
            waiting += [kind for kind in map(_base, found[name]) if not _BUILT_IN.match(kind)]
    return found


def departure(topic: RecordedTopic, recorded_hash: str) -> str:
    """Return in what a topic's recorded type differs from the installed one; '' if in nothing.

    Args:
        topic: as it was recorded.
        recorded_hash: RIHS01 hash of its type in metadata.yaml; '' without.
    """
    if topic.encoding != 'cdr':
        return f"its messages are in '{topic.encoding}', expected cdr"
    text, same = _installed_text(topic.type_name), _same_hash(topic.type_name, recorded_hash)
    if text is None and same is None:
        return f'{topic.type_name or "a type without a name"} is not installed'
    written = bool(topic.definition.strip())
    if text is not None and written and topic.definition_encoding == _ROS2MSG:
        found = _difference(topic, text)
        if found:
            return found
    elif written and same is None:
        return f"its definition is in '{topic.definition_encoding}', expected {_ROS2MSG}"
    return f'{topic.type_name} has another hash than the installed type' if same is False else ''


def is_unproven(topic: RecordedTopic, recorded_hash: str) -> bool:
    """Whether a bag holds nothing of a type but its name, so that nothing can be compared."""
    if topic.definition.strip() or _same_hash(topic.type_name, recorded_hash) is not None:
        return False
    return _installed_text(topic.type_name) != ''  # a type without fields has nothing to tell


def _installed_text(type_name: str) -> str | None:
    try:
        return definition(type_name)
    except BagError:
        return None


def _same_hash(type_name: str, recorded: str) -> bool | None:
    """Whether a hash is that of the installed type; None where one of the two is not known."""
    try:
        installed = type_hash(type_name)
    except BagError:
        return None
    return recorded == installed if installed and not _NO_HASH.match(recorded) else None


def _difference(topic: RecordedTopic, installed_text: str) -> str:
    try:
        recorded = layout(topic.type_name, topic.definition.decode('utf-8'))
    except ValueError as error:
        return f'its definition cannot be read ({error})'
    for kind, fields in layout(topic.type_name, installed_text).items():
        had = recorded.get(kind, ())
        if had != fields:
            return f'{kind} has {_first(had, fields)} in the bag, {_first(fields, had)} here'
    return ''


def _first(fields: tuple[str, ...], others: tuple[str, ...]) -> str:
    """Return the first field in which two layouts differ, as the first one has it."""
    for field, other in zip_longest(fields, others):
        if field != other:
            return f"'{field}'" if field else 'no further field'
    return 'the same'


def _fields(type_name: str, text: str) -> tuple[str, ...]:
    package = type_name.partition('/')[0]
    found = []
    for line in text.splitlines():
        bare = line.split('#', 1)[0].strip()
        if not bare:
            continue
        match = _FIELD.match(bare)
        if match is None:
            raise ValueError(f"'{bare[:40]}' is no field of a message")
        if not match['mark']:
            base = _SAME_ON_THE_WIRE.get(match['base'], match['base'])
            own = '/' in base or bool(_BUILT_IN.match(base))
            found.append(f'{_plain(base) if own else f"{package}/{base}"}{match["bounds"]} '
                         f'{match["name"]}')  # fmt: skip
    return tuple(found)


def _base(field: str) -> str:
    """Return the type of a field without its bounds."""
    return re.split(r'[\[<\s]', field, maxsplit=1)[0]


def _plain(type_name: str) -> str:
    """Return a type's name without its kind: 'sensor_msgs/msg/Imu' is 'sensor_msgs/Imu'."""
    return type_name.replace('/msg/', '/')
