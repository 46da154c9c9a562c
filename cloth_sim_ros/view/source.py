# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The interface of sources that a view shows."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

RUNNING = 'running'
PAUSED = 'paused'
STOPPED = 'stopped'


@dataclass(frozen=True)
class Moment:
    """
    The cloth as a view shows it.

    :param mode: of the simulation; empty where it is not known
    :param run_state: running, paused, or stopped when the run cannot go on
    :param note: what there is to say of it, such as why it has stopped
    :param picture: of the camera that is shown, (height, width, 3) uint8; None without one
    """

    frame: Frame
    mode: str
    run_state: str
    note: str = ''
    picture: np.ndarray | None = None


class Source(ABC):
    """
    A cloth that moves, of which the latest moment can be had from any thread.

    What is requested raises ClothSimError when it cannot be done. What ``modes``, ``can_act``,
    ``span`` and ``cameras`` rule out is not offered by the page: a source need not define it, and
    refuses it.

    :param name: of the scene, the recording or the node
    :param modes: that ``set_mode`` takes; none where the mode is settled
    :param can_act: whether the cloth can be stepped, pushed, pinned and reset
    :param span: first and last time [s] where the view can go to any; None where it cannot
    :param cameras: names of those whose pictures can be shown
    """

    name: str
    modes: tuple[str, ...] = ()
    can_act: bool = False
    span: tuple[float, float] | None = None
    cameras: tuple[str, ...] = ()

    @abstractmethod
    def latest(self) -> Moment | None:
        """Return the latest moment; None before the first."""

    @abstractmethod
    def set_paused(self, is_paused: bool) -> None:
        """Pause or resume the time."""

    @abstractmethod
    def close(self) -> None:
        """Free all resources."""

    # A page asks for these only where `span`, `modes`, `can_act` and `cameras` say that the source
    # has them.
    def go_to(self, time: float) -> None:
        """Show the moment at ``time`` [s], and stay there."""
        raise self._refusal('go to a time', 'a recording')

    def set_mode(self, mode: str) -> None:
        """Step with ``mode`` from now on."""
        raise self._refusal('change its mode')

    def show_camera(self, name: str, part: str) -> None:
        """Let moments have the picture of a camera, its COLOR or DEPTH; an empty name: none."""
        raise self._refusal('show a camera', 'a scene')

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt while paused."""
        raise self._refusal('step')

    def reset(self) -> None:
        """Go back to the start."""
        raise self._refusal('be reset')

    def push(
            self, force: Sequence[float], center: Sequence[float], radius: float,
            duration: float) -> None:
        """Push the nodes within ``radius`` of ``center`` [m] with ``force`` [N] in all."""
        raise self._refusal('be pushed')

    def hold(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is."""
        raise self._refusal('take new pins')

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col)."""
        raise self._refusal('release pins')

    def move_pin(self, row: int, col: int, target: Sequence[float]) -> None:
        """Let the pin (row, col) move to ``target`` [m]."""
        raise self._refusal('move pins')

    def _refusal(self, what: str, instead: str = 'a scene or a running node') -> ClothSimError:
        return ClothSimError(f'{self.name} cannot {what}: view {instead} for that')
