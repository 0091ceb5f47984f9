# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A device in place of a channel of the sim: its names, its errors and what is wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hexapod_sim.degradation import Degradation, Distortion
from hexapod_sim.driver_faults import DEVICES, fault_names, faults
from hexapod_sim.joint_layout import JointLayout
from hexapod_sim.message_fields import read, write
from hexapod_sim.robot import JOINTS

OUR_ORDER, REVERSED, SHUFFLED = 'ours', 'reversed', 'shuffled'


class FakeDevice:
    """Turns messages of the sim into those of a device.

    Attributes:
        channel: name of the channel that it measures.
        topics: topics of the sim that it takes the place of.
    """

    def __init__(self, settings: Mapping[str, Any]) -> None:
        """Read the settings, named as the parameters of the node `fake_driver`.

        Raises:
            ValueError: one does not suit the channel; the text names it.
        """
        self.channel: str = settings['channel']
        self._row = DEVICES[self.channel]
        self.topics = self._row.topics
        self._own_topic: str = settings['topic'] or f'driver/{self.channel}'
        self._own_frame: str = settings['frame']
        self._seed: int = settings['seed']
        self._faults = faults(self._row)
        self._layout = self._joint_layout(settings)
        self._degradations = self._all_degradations(settings)
        self.check_fault(settings['fault'])

    def own_topic(self, topic: str) -> str:
        """Return the device's own name of a topic of the sim."""
        return self._own_topic + topic.removeprefix(self.channel)

    def degrade(self, message: Any, topic: str, stamp_ns: int, fault: str) -> None:
        """Turn a message of a topic of the sim into one of the device, in place."""
        if self._own_frame:
            leg = topic.removeprefix(self.channel).replace('/', '_')
            message.header.frame_id = self._own_frame + leg
        for path, degradation in self._degradations[topic].items():
            write(message, path, degradation.apply(read(message, path), stamp_ns))
        if self._layout is not None:
            self._layout.apply(message)
        if fault in self._faults:
            self._faults[fault](message)

    def check_fault(self, fault: str) -> None:
        """Refuse a fault that this channel cannot have.

        Raises:
            ValueError: the text says which ones it can have.
        """
        allowed = fault_names(self._row)
        if fault and fault not in allowed:
            raise ValueError(
                f"fault '{fault}': {self.channel} cannot have it, expected one of "
                f'{", ".join(allowed)}'
            )

    def _all_degradations(self, settings: Mapping[str, Any]) -> dict[str, dict[str, Degradation]]:
        """Return what happens to each field of each topic, each from a stream of its own."""
        errors = ('noise', 'bias', 'quantisation')
        distortions = [Distortion(*(settings[name] for name in errors))]
        velocity = [settings[f'velocity_{name}'] for name in errors]
        fields = self._row.observed
        if len(fields) > 1:
            distortions.append(Distortion(*velocity))
        elif any(velocity):
            raise ValueError(f'velocity_*: expected channel joint_states, not {self.channel}')
        streams = iter(range(len(fields) * len(self.topics)))
        return {
            topic: {
                field.path: Degradation(distortion, field.kind, self._seed, next(streams))
                for field, distortion in zip(fields, distortions, strict=True)
            }
            for topic in self.topics
        }

    def _joint_layout(self, settings: Mapping[str, Any]) -> JointLayout | None:
        """Return the device's own order and names of the joints; None where they are ours."""
        order, prefix = settings['joint_order'], settings['joint_prefix']
        extra = settings['extra_joints']
        if not self._row.has_joints:
            if order != OUR_ORDER or prefix or extra:
                raise ValueError(f'joint_*: expected a channel with joints, not {self.channel}')
            return None
        if extra and order != SHUFFLED:
            raise ValueError(f'extra_joints {extra}: expected joint_order {SHUFFLED}')
        if order == SHUFFLED:
            return JointLayout.shuffled(len(JOINTS), extra, prefix, self._seed)
        step = -1 if order == REVERSED else 1
        return JointLayout(range(len(JOINTS))[::step], prefix)
