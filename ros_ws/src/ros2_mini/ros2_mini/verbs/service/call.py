# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""`ros2 service call`: send a request and print the response."""

import argparse
import time

from ros2_mini.calls import result_of
from ros2_mini.errors import CommandError
from ros2_mini.interfaces import load_type
from ros2_mini.message_fill import add_values_argument, fill_message, given_values
from ros2_mini.node_context import open_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of `ros2 service call`."""
    parser.add_argument('service_name', help="Name of the ROS service (e.g. '/set_flag')")
    parser.add_argument('service_type', help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')")
    add_values_argument(
        parser,
        'values',
        "Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}')",
    )
    parser.add_argument(
        '-r', '--rate', metavar='N', type=float, help='Repeat the call at a specific rate in Hz'
    )


def main(args: argparse.Namespace) -> int:
    """Call once, or at a rate until interrupted."""
    if args.rate is not None and args.rate <= 0:
        raise CommandError(f'rate must be greater than zero, but is {args.rate}')
    service_type = load_type(args.service_type, 'srv')
    request = service_type.Request()
    fill_message(request, given_values(args))
    with open_node() as node:
        client = node.create_client(service_type, args.service_name)
        if not client.service_is_ready():
            print('waiting for service to become available...')
            client.wait_for_service()
        while True:
            print(f'requester: making request: {request!r}\n')
            start = time.monotonic()
            response = result_of(node, client.call_async(request), args.service_name)
            print(f'response:\n{response!r}\n')
            if args.rate is None:
                return 0
            time.sleep(max(0.0, start + 1.0 / args.rate - time.monotonic()))
