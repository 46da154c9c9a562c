# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Changes of pins, checked when they are asked for and made when no step is under way."""

from collections.abc import Sequence

from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.pin_path import PinPath
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stepping import Stepping
import numpy as np


class PinRequests:
    """
    Pin, release and move nodes, now or at the end of the step under way.

    :param motion: the pins of the run
    """

    def __init__(self, motion: PinMotion, state: State, stepping: Stepping) -> None:
        """Begin with the pins of ``state``."""
        self._motion = motion
        self._state = state
        self._stepping = stepping
        # Pins that the step under way still has otherwise.
        self._to_be: dict[tuple[int, int], bool] = {}

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool, with the changes yet to be made."""
        if not self._stepping.is_mid_step:
            self._to_be.clear()
        pinned = self._state.pinned.copy()
        for node, is_pinned in self._to_be.items():
            pinned[node] = is_pinned
        return pinned

    def hold(self, row: int, col: int) -> None:
        """Hold the node (row, col) where it is then."""
        self._change(row, col, True)

    def release(self, row: int, col: int) -> None:
        """Let the node (row, col) go."""
        self._change(row, col, False)

    def move(
            self, row: int, col: int, target: Sequence[float], speed: float | None) -> PinPath:
        """Move the pin (row, col); return its way, as far as it can be told now."""
        stepping = self._stepping
        if not stepping.is_mid_step:
            return self._motion.move(row, col, target, speed, stepping.time)
        self._motion.check_node(row, col)
        then = stepping.edit_time
        with self._state.at_kept():
            path = self._motion.foresee(
                row, col, target, speed, then, is_pinned=self.pinned_nodes()[row, col],
                now=self._state.read_position(row, col))
        stepping.at_rest(lambda: self._motion.move(row, col, target, speed, then))
        return path

    def _change(self, row: int, col: int, is_pinned: bool) -> None:
        self._motion.check_node(row, col)
        # What an earlier step has left is settled.
        self.pinned_nodes()
        if self._stepping.is_mid_step:
            self._to_be[row, col] = is_pinned
        change = self._motion.hold if is_pinned else self._motion.release
        self._stepping.at_rest(lambda: change(row, col))
