# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""What is sent of the pins, as long as there are not too many: their frames and their wrenches."""

from collections.abc import Callable
from collections.abc import Collection
from collections.abc import Mapping
from functools import partial
from typing import Any

from cloth_sim_ros.messages.pins import PinFrames
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.pins import WrenchMessages
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

FRAMES, WRENCHES = 'tf', 'pins/wrenches'
_PARAMETERS = {FRAMES: 'publish.tf', WRENCHES: 'publish.wrenches'}


class PinTopics:
    """
    Send /tf, one message a frame, and ~/pins/wrenches, one message a pin.

    :param values: the node's parameter values, read at each frame
    :param node_name: with its namespace
    :param warn: called with the reason when pins become too many
    """

    def __init__(
            self, simulation: Simulation, outlet: Outlet, values: Mapping[str, Any],
            node_name: str, warn: Callable[[str], None]) -> None:
        """Keep the parts."""
        self._simulation = simulation
        self._outlet = outlet
        self._values = values
        self._warn = warn
        self._frames = PinFrames(node_name, values['frame_id'])
        self._wrenches = WrenchMessages(node_name)
        self._reason = ''

    def wanted(self, *, by_recording: bool = True) -> frozenset[str]:
        """Return which of FRAMES and WRENCHES are to be sent; WRENCHES need the pins' forces."""
        wanted = frozenset(
            key for key, parameter in _PARAMETERS.items()
            if self._values[parameter] and self._outlet.wanted(key, by_recording=by_recording))
        if not wanted:
            return wanted
        pins = int(np.count_nonzero(
            self._simulation.pinned_nodes() & ~self._simulation.grasped_nodes()))
        reason = too_many_pins(pins)
        if reason and not self._reason:
            self._warn(reason)
        self._reason = reason
        return wanted if pins > 0 and not reason else frozenset()

    def send(
            self, snapshot: Snapshot, wanted: Collection[str], *,
            to_recording: bool = True) -> None:
        """Send what is ``wanted`` of ``snapshot``, the frames before what is given in them."""
        held = self._simulation.grasped_nodes()
        if FRAMES in wanted:
            self._outlet.send(
                FRAMES, lambda: self._frames.serialise(snapshot, held), snapshot.time,
                to_recording=to_recording)
        if WRENCHES in wanted:
            for data in self._wrenches.serialise(snapshot, held):
                self._outlet.send(
                    WRENCHES, partial(bytes, data), snapshot.time, to_recording=to_recording)
