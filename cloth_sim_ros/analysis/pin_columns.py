# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces on the holders of pins, as columns of a run's table."""

from collections.abc import Mapping

from cloth_sim_ros.analysis.entry import Entry
from cloth_sim_ros.messages.frame_names import node_of_pin
import numpy as np

KEY = 'pins/wrenches'
SUM = ('pin_force_x', 'pin_force_y', 'pin_force_z')
LARGEST = 'largest_pin_force'
MOST_PINS = 16

Node = tuple[int, int]


class PinColumns:
    """Collects the force of the cloth on each holder [N], moment by moment."""

    def __init__(self) -> None:
        """Begin without forces."""
        self._forces: dict[tuple[int, float], dict[Node, tuple[float, float, float]]] = {}

    def read(self, entry: Entry) -> None:
        """Take a message of ~/pins/wrenches; that of no pin is passed over."""
        node = node_of_pin(entry.message.header.frame_id)
        if node is not None:
            force = entry.message.wrench.force
            self._forces.setdefault((entry.resets, entry.time), {})[node] = (
                force.x, force.y, force.z)

    def columns(self, moments: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """
        Return the sum of all pins, the largest, and each pin where there are MOST_PINS or fewer.

        A value is nan where nothing was recorded. The columns of the pin (r, c) are
        ``pin_r_c_force_x`` and so on.

        :param moments: columns ``time`` and ``resets`` of the table
        """
        nodes = sorted({node for forces in self._forces.values() for node in forces})
        shown = nodes if len(nodes) <= MOST_PINS else []
        places = {node: 4 + 3 * number for number, node in enumerate(shown)}
        values = np.full((len(moments['time']), 4 + 3 * len(shown)), np.nan)
        for row, moment in enumerate(zip(moments['resets'].tolist(), moments['time'].tolist())):
            forces = self._forces.get(moment, {})
            if forces:
                vectors = np.array(list(forces.values()))
                values[row, :3] = vectors.sum(axis=0)
                values[row, 3] = np.linalg.norm(vectors, axis=1).max()
            for node in places.keys() & forces.keys():
                values[row, places[node]:places[node] + 3] = forces[node]
        names = [*SUM, LARGEST, *(
            f'pin_{row}_{col}_force_{axis}' for row, col in shown for axis in 'xyz')]
        return dict(zip(names, values.T.copy()))
