# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The base of every node of the hexapod: no peer can end it by what it sends."""

from collections.abc import Callable
from typing import Any

from rclpy import node as rclpy_node
from rclpy.service import Service
from rclpy.subscription import Subscription

from hexapod_node.handlers import answering, count_failure, guarded
from hexapod_node.timers import cancel_all


class Node(rclpy_node.Node):
    """A node whose handlers of messages and requests may fail, those of rclpy's own included."""

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Callable[..., None], *args: Any, **options: Any
    ) -> Subscription:
        """Subscribe; messages at which the callback fails are dropped and counted."""
        handler = guarded(self, topic, callback)
        return super().create_subscription(msg_type, topic, handler, *args, **options)

    def create_service(
        self, srv_type: Any, srv_name: str, callback: Callable[..., Any], **options: Any
    ) -> Service:
        """Offer a service; requests at which the callback fails are answered so and counted."""
        handler = answering(self, srv_type, srv_name, callback)
        service = super().create_service(srv_type, srv_name, handler, **options)
        send = service.send_response

        def send_if_possible(response: Any, header: Any) -> None:
            try:
                send(response, header)
            except Exception as error:  # the client is gone, or a value has no place in its field
                count_failure(self, srv_name, error)

        service.send_response = send_if_possible  # type: ignore[method-assign]
        return service

    def destroy_node(self) -> None:
        """End the node's timers, then the node."""
        cancel_all(self)
        super().destroy_node()
