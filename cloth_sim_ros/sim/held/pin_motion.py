# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pins of a run: which nodes they hold, their moves, and requests to them."""

from collections.abc import Collection
from collections.abc import Sequence
import math

from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.model.pins import PinMove
from cloth_sim_ros.sim.model.pins import PinPath
from cloth_sim_ros.sim.model.pins import Way
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Rounding of the end of a path, in steps of dt [1].
_NOTHING = 1e-9
_REST = np.zeros(3)
# Distance of a pin from its place [m] that is no rounding.
_OFF = 1e-6

Node = tuple[int, int]
# The moves to come, the ways under way, the velocities on the device, those of nodes that were
# pinned since the last step, and how far pins are off their ways.
KeptMotion = tuple[
    list[PinMove], dict[Node, Way], dict[Node, np.ndarray], dict[Node, np.ndarray],
    dict[Node, np.ndarray]]


class PinMotion:
    """
    Gives moving pins their velocity before each step of dt, and their position after it.

    All substeps of a step have the same velocity. A step in which a move begins or ends has the
    one that leads to where the pin is at its end. Nothing is done while no pin moves.

    :param scene: its timed moves begin at their times, where their nodes are pinned by then
    """

    def __init__(self, scene: Scene, state: State) -> None:
        """Wait for the timed moves."""
        self._scene = scene
        self._state = state
        self._waiting = sorted(scene.timed_pin_moves(), key=lambda move: move.start)
        self._paths: dict[Node, Way] = {}
        # What the state has now.
        self._on_device: dict[Node, np.ndarray] = {}
        # What nodes had that were free when they were pinned, since the last step.
        self.caught: dict[Node, np.ndarray] = {}
        # From their ways [m], of pins that stopped where the cloth would pass through itself.
        self._off: dict[Node, np.ndarray] = {}
        self._stalled = 0

    @property
    def under_way(self) -> tuple[PinMove, ...]:
        """Return the moves that have begun and not ended."""
        return tuple(path.move for path in self._own_paths().values())

    @property
    def moving(self) -> list[Node]:
        """Return the row and column of each pin whose move has begun and not ended."""
        return list(self._own_paths())

    @property
    def velocities(self) -> dict[Node, np.ndarray]:
        """Return the velocities of pins now [m/s], those at rest left out or 0."""
        return self._on_device

    @property
    def stalled(self) -> int:
        """Return how many pins stood still in the last step, as they were pulled too hard."""
        return self._stalled

    def hold(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is, at rest; a pin that moves stops."""
        self.check_node(row, col)
        if not self._state.pinned[row, col]:
            self.caught[row, col] = self._state.read_velocity(row, col)
        self._stop((row, col))
        self._state.set_pinned(row, col, True)

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col), with the velocity its pin has."""
        self.check_node(row, col)
        for entries in (self._paths, self._on_device, self.caught, self._off):
            entries.pop((row, col), None)
        self._state.set_pinned(row, col, False)

    def move(
            self, row: int, col: int, target: Sequence[float], speed: float | None,
            now: float) -> PinPath:
        """
        Begin to move the pin (row, col) ``now`` [s], instead of a move in progress.

        :param speed: [m/s]; None for the scene's pin_speed
        :return: its path, with the time of arrival
        :raises ClothSimError: when the node is not pinned or a value is wrong
        """
        self.check_node(row, col)
        return self._start(
            self._checked(row, col, target, speed, now, self._state.pinned[row, col]))

    def follow(self, row: int, col: int, way: Way) -> None:
        """Let the pin (row, col) follow a moving frame."""
        self._paths[row, col] = way

    def position(self, row: int, col: int, now: float) -> np.ndarray:
        """Return where the pin (row, col) is ``now`` [s], (3,) [m]."""
        path = self._paths.get((row, col))
        if path is None:
            return self._state.read_position(row, col)
        return path.position(now) + self._off.get((row, col), _REST)

    def drop(self) -> None:
        """Forget the moves in progress: the state was replaced, and its pins are at rest."""
        for entries in (self._paths, self._on_device, self.caught, self._off):
            entries.clear()

    def leave_out_before(self, now: float) -> None:
        """Drop the timed moves that would have begun before ``now`` [s]."""
        self._waiting = [move for move in self._waiting if move.start >= now]

    def rests_until(self, now: float) -> float:
        """Return until when no pin moves: ``now`` [s] itself where one does, or infinite."""
        if self._paths:
            return now
        return max(self._waiting[0].start, now) if self._waiting else math.inf

    def rest(self) -> None:
        """Note that no pin has moved in the last step."""
        self._stalled = 0

    def begin_step(self, begin: float, end: float, too_hard: Collection[Node] = ()) -> None:
        """
        Set the velocities of the step from ``begin`` to ``end`` [s].

        :param too_hard: of ``moving``, the pins that are pulled too hard to go on: they stand
            still, and their way is made that much later
        """
        self._stalled = len(too_hard)
        if not (self._paths or self._waiting):
            return
        own = self._own_paths()
        for node in too_hard:
            self._paths[node] = own[node].put_off(begin, end)
        places = {node: path.position(begin) for node, path in self._paths.items()}
        while self._waiting and self._waiting[0].start < end:
            move = self._waiting.pop(0)
            if self._state.pinned[move.node]:
                self._start(move)
        for node, path in self._paths.items():
            at_begin = places.get(node, path.position(path.begin))
            self._set_velocity(node, path.velocity(begin, end, at_begin))

    def end_step(self, begin: float, end: float) -> None:
        """
        Put the pins where they are at ``end`` [s]; those at their target come to rest.

        One that was stopped short stays off its way by that, until its next move of its own.
        """
        nothing = _NOTHING * (end - begin)
        were_stopped, self._state.were_pins_stopped = self._state.were_pins_stopped, False
        for node, path in list(self._paths.items()):
            arrives = path.arrival <= end + nothing
            on_way = path.position(path.arrival if arrives else end)
            place = on_way + self._off.get(node, _REST)
            if were_stopped:
                present = self._state.read_position(*node)
                if np.abs(present - place).max() > _OFF:
                    self._off[node], place = present - on_way, present
            # Each substep has rounded its position to float32.
            self._state.place_pin(*node, place)
            if arrives:
                self._stop(node)

    def keep(self) -> KeptMotion:
        """Return what ``restore`` needs to come back to this moment."""
        return (
            list(self._waiting), dict(self._paths), dict(self._on_device), dict(self.caught),
            dict(self._off))

    def restore(self, kept: KeptMotion) -> None:
        """Go back to the moment of ``keep``, to which the state has gone back already."""
        given_since = self._on_device
        waiting, paths, on_device, caught, off = kept
        self._waiting = list(waiting)
        self._paths, self._on_device = dict(paths), dict(on_device)
        self.caught, self._off = dict(caught), dict(off)
        # The first step after that moment gave its velocities to the state as it was then.
        for node in given_since:
            self._state.set_pin_velocity(*node, self._on_device.get(node, _REST))

    def _checked(
            self, row: int, col: int, target: Sequence[float], speed: float | None,
            start: float, is_pinned: bool) -> PinMove:
        if not is_pinned:
            raise NotFoundError(
                f'node ({row}, {col}) is free and only a pin can be moved: pin it first')
        return PinMove.checked(
            row=row, col=col, target=target, start=start,
            speed=self._scene['pin_speed'] if speed is None else speed)

    def check_node(self, row: int, col: int) -> None:
        """Raise ClothSimError when there is no such node."""
        self._scene.checked_node(row, col)

    def _start(self, move: PinMove) -> PinPath:
        path = PinPath(move, self.position(*move.node, move.start))
        self._off.pop(move.node, None)
        self._paths[move.node] = path
        return path

    def _own_paths(self) -> dict[Node, PinPath]:
        return {node: path for node, path in self._paths.items() if isinstance(path, PinPath)}

    def _stop(self, node: Node) -> None:
        self._paths.pop(node, None)
        self._set_velocity(node, _REST)

    def _set_velocity(self, node: Node, velocity: np.ndarray) -> None:
        # Each change is an edit, after which a mode has to examine the state again.
        if not np.array_equal(velocity, self._on_device.get(node, _REST)):
            self._state.set_pin_velocity(*node, velocity)
            self._on_device[node] = velocity
