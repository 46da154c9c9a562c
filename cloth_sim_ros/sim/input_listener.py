# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who is told of what is done to a simulation from outside."""

from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.push import Push

RESET, CLEAR_PUSHES = 'reset', 'clear_pushes'


class InputListener:
    """
    Hears of each input once it is accepted, at the simulated time at which it acts.

    To be derived from; does nothing by itself.
    """

    def push(self, push: Push) -> None:
        """Hear of an accepted push."""

    def pin(self, row: int, col: int, pinned: bool) -> None:
        """Hear of a node that was pinned or released."""

    def pin_target(self, move: PinMove) -> None:
        """Hear of a pin that sets off."""

    def grasp(self, grasp: Grasp) -> None:
        """Hear of nodes that are held."""

    def grasp_release(self, name: str, by_force: bool) -> None:
        """Hear of nodes that are let go; ``by_force``: as the cloth has pulled too hard."""

    def grasp_move(self, move: FrameMove) -> None:
        """Hear of a grasp that sets off."""

    def collider_move(self, move: FrameMove) -> None:
        """Hear of a collider that sets off."""

    def wind(self, velocity: tuple[float, float, float]) -> None:
        """Hear of another steady wind [m/s]."""

    def mode(self, mode: str, previous: str) -> None:
        """Hear of a switch of the mode."""

    def command(self, command: str) -> None:
        """Hear of a RESET or of CLEAR_PUSHES, which is about to be carried out."""

    def new_state(self) -> None:
        """Hear that positions and velocities are about to be replaced; raise to refuse it."""
