# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""~/pins/wrenches: what each pin feels, as long as there are not too many of them."""

from collections.abc import Callable
from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.messages.wrenches import too_many_pins
from cloth_sim_ros.messages.wrenches import WrenchMessages
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

_KEY = 'pins/wrenches'


class WrenchTopic:
    """
    Send a message for each pin.

    :param values: the node's parameter values, read at each frame
    :param warn: called with the reason when pins become too many
    """

    def __init__(
            self, simulation: Simulation, outlet: Outlet, values: Mapping[str, Any],
            warn: Callable[[str], None]) -> None:
        """Keep the parts."""
        self._simulation = simulation
        self._outlet = outlet
        self._values = values
        self._warn = warn
        self._messages = WrenchMessages(values['frame_id'])
        self._reason = ''

    def wanted(self, *, by_recording: bool = True) -> bool:
        """Tell whether forces at the pins have to be computed."""
        if not (self._values['publish.wrenches']
                and self._outlet.wanted(_KEY, by_recording=by_recording)):
            return False
        pins = int(np.count_nonzero(self._simulation.pinned_nodes()))
        reason = too_many_pins(pins)
        if reason and not self._reason:
            self._warn(reason)
        self._reason = reason
        return pins > 0 and not reason

    def send(self, snapshot: Snapshot, *, to_recording: bool = True) -> None:
        """Send the messages of ``snapshot``, which has the forces at its pins."""
        for data in self._messages.serialise(snapshot):
            self._outlet.send(
                _KEY, lambda data=data: data, snapshot.time, to_recording=to_recording)
