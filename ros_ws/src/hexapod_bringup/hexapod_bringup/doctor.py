# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Command line `doctor`: whether this machine is ready for the graph, one line each.

Every check is a function that returns a `Finding`; what is wrong comes with its cure. Checks read
the machine and change nothing.
"""

import fcntl
import importlib.metadata
import importlib.util
import os
import platform
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hexapod_doe.cores import usable_cores
from hexapod_sim.command_line import CommandLine
from rich.console import Console

FINE, NOTE, WRONG = 'fine', 'note', 'wrong'
_STYLES = {FINE: 'green', NOTE: 'yellow', WRONG: 'red'}
_PYTHONS = ((3, 11), (3, 12))
_PACKAGES = (
    'hexapod_interfaces', 'hexapod_node', 'hexapod_sim', 'hexapod_cpg', 'hexapod_agent',
    'hexapod_doe', 'hexapod_bringup',
)  # fmt: skip
_RANGES = ('LOCALHOST', 'SUBNET', 'OFF', 'SYSTEM_DEFAULT')
_MOST_DOMAIN = 101  # above, the ports of DDS meet those that Linux gives to anybody
_DDS_GROUP = '239.255.0.1'  # of the DDS standard's discovery, RTPS 2.2, 9.6.1.4
_SHARED_MEMORY = Path('/dev/shm')
_LEAST_DISK, _LEAST_SHARED = 2e9, 64e6  # bytes
_TICK_S, _TICKS, _LATE_S = 0.025, 40, 0.005
_DISCOVERY_S = 15.0
_PROFILES = ('FASTDDS_DEFAULT_PROFILES_FILE', 'FASTRTPS_DEFAULT_PROFILES_FILE')


@dataclass(frozen=True)
class Finding:
    """What one check found.

    Attributes:
        state: `fine`, `note` (works, but should be known) or `wrong`.
        text: What was found.
        cure: What to do about it.
    """

    state: str
    text: str
    cure: str = ''


def python() -> Finding:
    """Check that the interpreter is one that ROS's libraries are built for."""
    text = f'{platform.python_implementation()} {platform.python_version()}'
    if platform.python_implementation() == 'CPython' and sys.version_info[:2] in _PYTHONS:
        return Finding(FINE, text)
    return Finding(WRONG, text, 'make a new .venv with CPython 3.11 or 3.12: make clean setup')


def ros(environment: Mapping[str, str] = os.environ) -> Finding:
    """Check which ROS the libraries are of."""
    distribution = environment.get('ROS_DISTRO', 'jazzy')
    if distribution != 'jazzy':
        return Finding(WRONG, f'{distribution} is sourced', 'begin with a shell that does not')
    spec = importlib.util.find_spec('rclpy')
    if spec is None or spec.origin is None:
        return Finding(WRONG, 'no rclpy', 'source setup.bash')
    try:
        return Finding(FINE, f'wheels, rclpy {importlib.metadata.version("ros-jazzy-rclpy")}')
    except importlib.metadata.PackageNotFoundError:
        return Finding(FINE, f'a stock install, {Path(spec.origin).parent}')


def workspace() -> Finding:
    """Check that all packages of the workspace can be imported."""
    missing = [name for name in _PACKAGES if importlib.util.find_spec(name) is None]
    if missing:
        return Finding(WRONG, f'no {", ".join(missing)}', 'make setup, then source setup.bash')
    return Finding(FINE, f'{len(_PACKAGES)} packages')


def variables(environment: Mapping[str, str] = os.environ) -> Finding:
    """Check for variables that were left over and change how nodes talk."""
    if environment.get('ROS_LOCALHOST_ONLY', '0') not in ('', '0'):
        cure = 'unset ROS_LOCALHOST_ONLY; ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST does that now'
        return Finding(WRONG, 'ROS_LOCALHOST_ONLY overrides the discovery range', cure)
    middleware = environment.get('RMW_IMPLEMENTATION', '')
    if middleware and importlib.util.find_spec('ament_index_python') is not None:
        from ament_index_python.resources import get_resources

        if middleware not in get_resources('rmw_typesupport'):
            text = f'RMW_IMPLEMENTATION={middleware} is not installed here'
            return Finding(WRONG, text, 'unset RMW_IMPLEMENTATION')
    for name in _PROFILES:
        if environment.get(name) and not Path(environment[name]).is_file():
            return Finding(WRONG, f'{name}={environment[name]}: no such file', f'unset {name}')
    told = [
        name
        for name in ('ROS_DISCOVERY_SERVER', 'ROS_STATIC_PEERS', 'RMW_IMPLEMENTATION', *_PROFILES)
        if environment.get(name)
    ]
    if told:
        texts = ', '.join(f'{name}={environment[name]}' for name in told)
        return Finding(NOTE, texts, 'every shell of the graph needs the same')
    return Finding(FINE, 'none that change how nodes talk')


def domain(environment: Mapping[str, str] = os.environ) -> Finding:
    """Check the number that graphs on one network are told apart by."""
    text = environment.get('ROS_DOMAIN_ID') or '0'
    if not text.isdecimal() or int(text) > _MOST_DOMAIN:
        cure = f'export ROS_DOMAIN_ID=N, 0 to {_MOST_DOMAIN}'
        return Finding(WRONG, f'ROS_DOMAIN_ID={text}', cure)
    return Finding(FINE, text)


def discovery_range(environment: Mapping[str, str] = os.environ) -> Finding:
    """Check how far nodes look for each other."""
    text = environment.get('ROS_AUTOMATIC_DISCOVERY_RANGE') or 'SUBNET'
    if text not in _RANGES:
        cure = f'export ROS_AUTOMATIC_DISCOVERY_RANGE={"|".join(_RANGES[:2])}'
        return Finding(WRONG, f'{text} is none', cure)
    if text == 'OFF':
        cure = 'export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST, or SUBNET for several hosts'
        return Finding(WRONG, 'OFF: nodes do not find each other', cure)
    if text == 'LOCALHOST':
        return Finding(FINE, 'LOCALHOST: this machine alone; workers on other hosts need SUBNET')
    return Finding(FINE, f'{text}: everybody on this network may join')


def multicast(environment: Mapping[str, str] = os.environ) -> Finding:
    """Check that what is sent to the group of DDS discovery arrives on this machine."""
    try:
        arrived = _multicast_arrives()
        text = 'arrives' if arrived else 'does not arrive'
    except OSError as error:
        arrived, text = False, str(error)
    if arrived:
        return Finding(FINE, text)
    cure = 'allow multicast in the firewall, or name the hosts: ROS_STATIC_PEERS="host1;host2"'
    needed = environment.get('ROS_AUTOMATIC_DISCOVERY_RANGE') != 'LOCALHOST'
    return Finding(WRONG if needed else NOTE, text, cure)


def _multicast_arrives() -> bool:
    """Send a word to the group and wait for it.

    Raises:
        OSError: The network refuses.
    """
    word = os.urandom(8)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        receiver.bind(('', 0))
        everywhere = socket.inet_aton(_DDS_GROUP) + socket.inet_aton('0.0.0.0')
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, everywhere)
        receiver.settimeout(1.0)
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        sender.sendto(word, (_DDS_GROUP, receiver.getsockname()[1]))
        try:
            return receiver.recv(len(word)) == word
        except TimeoutError:
            return False


def shared_memory(folder: Path = _SHARED_MEMORY) -> Finding:
    """Check the room for messages within this machine, and what killed nodes left there."""
    if not folder.is_dir():
        return Finding(NOTE, f'no {folder}', 'messages go through the network stack, slower')
    free = shutil.disk_usage(folder).free
    left = [file for file in folder.glob('fastrtps_*_el') if _is_abandoned(file)]
    if free < _LEAST_SHARED:
        text = f'{free / 1e6:.0f} MB free in {folder}'
        return Finding(WRONG, text, f'end what fills it, or rm {folder}/fastrtps_* without nodes')
    if left:
        text = f'{len(left)} segments of nodes that were killed, {free / 1e9:.1f} GB free'
        return Finding(NOTE, text, f'once no node runs: rm {folder}/fastrtps_*')
    return Finding(FINE, f'{free / 1e9:.1f} GB free, nothing left over')


def _is_abandoned(lock: Path) -> bool:
    """Whether nobody holds the lock that Fast DDS keeps on a segment for as long as it lives."""
    try:
        with lock.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # somebody else's, or gone meanwhile
        return False
    return True


def clock() -> Finding:
    """Check that a tick of 25 ms comes when it is due."""
    began = time.monotonic()
    late = []
    for tick in range(1, _TICKS + 1):
        due = began + tick * _TICK_S
        time.sleep(max(0.0, due - time.monotonic()))
        late.append(time.monotonic() - due)
    worst = f'{1000 * max(late):.1f} ms late at worst in {_TICKS} ticks of 40 Hz'
    if max(late) > _LATE_S:
        cure = 'lock-step does not mind; for a robot in real time free a core (realtime_report)'
        return Finding(NOTE, worst, cure)
    return Finding(FINE, worst)


def disk(folder: Path | None = None) -> Finding:
    """Check the room for bags."""
    folder = folder or Path.cwd()
    free = shutil.disk_usage(folder).free
    text = f'{free / 1e9:.0f} GB free in {folder}'
    if not os.access(folder, os.W_OK):
        return Finding(WRONG, f'{folder} cannot be written', 'go to a folder of your own')
    if free < _LEAST_DISK:
        return Finding(WRONG, text, f'free some: a campaign needs {_LEAST_DISK / 1e9:.0f} GB')
    return Finding(FINE, text)


def cores() -> Finding:
    """Check how many cores a campaign may use."""
    usable, there = usable_cores(), os.cpu_count() or 1
    text = f'{usable} of {there} may be used: so many workers train side by side'
    if usable < there:
        return Finding(NOTE, text, 'the affinity, a container or a batch system sets that')
    return Finding(FINE, text)


def talk() -> Finding:
    """Check that two processes find each other and a message gets through."""
    import rclpy
    from hexapod_node.session import begin
    from rclpy.node import Node
    from rclpy.utilities import try_shutdown
    from std_msgs.msg import String

    topic = f'doctor_{os.getpid()}'
    heard: list[String] = []
    begin([])
    node = Node('doctor')  # type: ignore[no-untyped-call,unused-ignore]
    node.create_subscription(String, topic, heard.append, 10)
    beacon = subprocess.Popen([sys.executable, __file__, '--beacon', topic])
    began = time.monotonic()
    try:
        while not heard and time.monotonic() < began + _DISCOVERY_S:
            rclpy.spin_once(node, timeout_sec=0.1)
    finally:
        beacon.kill()
        beacon.wait()
        node.destroy_node()
        try_shutdown()
    if heard:
        return Finding(FINE, f'a process hears another after {time.monotonic() - began:.1f} s')
    cure = 'see the lines above; a firewall, a VPN or another RMW_IMPLEMENTATION keeps them apart'
    return Finding(WRONG, f'a process does not hear another within {_DISCOVERY_S:g} s', cure)


def _beacon(topic: str) -> None:
    """Publish a word again and again, until killed."""
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    rclpy.init()
    node = Node('doctor_beacon')  # type: ignore[no-untyped-call,unused-ignore]
    publisher = node.create_publisher(String, topic, 10)
    end = time.monotonic() + 2 * _DISCOVERY_S
    while time.monotonic() < end:
        publisher.publish(String(data='hello'))
        time.sleep(0.1)


CHECKS: Mapping[str, Callable[[], Finding]] = {
    'Python': python,
    'ROS': ros,
    'workspace': workspace,
    'variables': variables,
    'domain': domain,
    'discovery range': discovery_range,
    'multicast': multicast,
    'shared memory': shared_memory,
    'clock': clock,
    'disk': disk,
    'cores': cores,
    'nodes talk': talk,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each check; return 1 if something is wrong."""
    parser = CommandLine(prog='doctor', description=(__doc__ or '').partition('\n')[0])
    parser.add_argument('--beacon', metavar='TOPIC', help='publish on a topic, for a check')
    args = parser.parse_args(arguments)
    if args.beacon:
        _beacon(args.beacon)
        return 0
    console, states = Console(soft_wrap=True, highlight=False), []
    for name, check in CHECKS.items():
        found = check()
        states.append(found.state)
        cure = f': {found.cure}' if found.cure else ''
        style = _STYLES[found.state]
        console.print(f'[{style}]{found.state:5}[/]  {name:15}  ', end='')
        console.print(f'{found.text}{cure}', markup=False)
    return 1 if WRONG in states else 0


if __name__ == '__main__':
    sys.exit(main())
