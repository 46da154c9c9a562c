# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pins of a run: which nodes they hold, where they go, and what is asked of them."""

from collections.abc import Collection
from collections.abc import Sequence
import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pins import checked_node
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.pins import PinPath
from cloth_sim_ros.sim.pins import Way
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stepping import Stepping
import numpy as np

# Of a step: what is left of a way that counts as none.
_NOTHING = 1e-9
_REST = np.zeros(3)

Node = tuple[int, int]
# The moves to come, the ways under way, the velocities on the device, and those of nodes that were
# pinned since the last step.
KeptMotion = tuple[
    list[PinMove], dict[Node, Way], dict[Node, np.ndarray], dict[Node, np.ndarray]]


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
        """Let the node (row, col) go, with the velocity its pin has."""
        self.check_node(row, col)
        for entries in (self._paths, self._on_device, self.caught):
            entries.pop((row, col), None)
        self._state.set_pinned(row, col, False)

    def move(
            self, row: int, col: int, target: Sequence[float], speed: float | None,
            now: float) -> PinPath:
        """
        Begin to move the pin (row, col) ``now`` [s], in place of a move under way.

        :param speed: [m/s]; None for the scene's pin_speed
        :return: its way, which tells when it arrives
        :raises ClothSimError: when the node is not pinned or a value is wrong
        """
        self.check_node(row, col)
        return self._start(
            self._checked(row, col, target, speed, now, self._state.pinned[row, col]))

    def foresee(
            self, row: int, col: int, target: Sequence[float], speed: float | None, then: float,
            *, is_pinned: bool, now: np.ndarray) -> PinPath:
        """
        Return the way of a ``move`` that is to begin at the later time ``then`` [s].

        :param is_pinned: whether the node will be pinned by then
        :param now: where the node is [m], (3,); a pin under way is known to be elsewhere then
        :raises ClothSimError: as ``move`` does
        """
        move = self._checked(row, col, target, speed, then, is_pinned)
        path = self._paths.get((row, col))
        return PinPath(move, now if path is None else path.position(then))

    def follow(self, row: int, col: int, way: Way) -> None:
        """Let the pin (row, col) follow what carries it."""
        self._paths[row, col] = way

    def position(self, row: int, col: int, now: float) -> np.ndarray:
        """Return where the pin (row, col) is ``now`` [s], (3,) [m]."""
        path = self._paths.get((row, col))
        return self._state.read_position(row, col) if path is None else path.position(now)

    def drop(self) -> None:
        """Forget the moves under way: the state was replaced, and its pins are at rest."""
        for entries in (self._paths, self._on_device, self.caught):
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
        """Put the pins where they are at ``end`` [s]; those at their target come to rest."""
        nothing = _NOTHING * (end - begin)
        for node, path in list(self._paths.items()):
            arrives = path.arrival <= end + nothing
            # Each substep has rounded its position to float32.
            self._state.place_pin(*node, path.position(path.arrival if arrives else end))
            if arrives:
                self._stop(node)

    def keep(self) -> KeptMotion:
        """Return what ``restore`` needs to come back to this moment."""
        return (
            list(self._waiting), dict(self._paths), dict(self._on_device), dict(self.caught))

    def restore(self, kept: KeptMotion) -> None:
        """Go back to the moment of ``keep``, to which the state has gone back already."""
        given_since = self._on_device
        waiting, paths, on_device, caught = kept
        self._waiting = list(waiting)
        self._paths, self._on_device = dict(paths), dict(on_device)
        self.caught = dict(caught)
        # The first step after that moment gave its velocities to the state as it was then.
        for node in given_since:
            self._state.set_pin_velocity(*node, self._on_device.get(node, _REST))

    def _checked(
            self, row: int, col: int, target: Sequence[float], speed: float | None,
            start: float, is_pinned: bool) -> PinMove:
        if not is_pinned:
            raise ClothSimError(
                f'node ({row}, {col}) is free and only a pin can be moved: pin it first')
        return PinMove.checked(
            row=row, col=col, target=target, start=start,
            speed=self._scene['pin_speed'] if speed is None else speed)

    def check_node(self, row: int, col: int) -> None:
        """Raise ClothSimError when there is no such node."""
        checked_node(row, col, self._scene.rows, self._scene.cols)

    def _start(self, move: PinMove) -> PinPath:
        path = PinPath(move, self.position(*move.node, move.start))
        self._paths[move.node] = path
        return path

    def _own_paths(self) -> dict[Node, PinPath]:
        return {node: path for node, path in self._paths.items() if isinstance(path, PinPath)}

    def _stop(self, node: Node) -> None:
        self._paths.pop(node, None)
        self._set_velocity(node, _REST)

    def _set_velocity(self, node: Node, velocity: np.ndarray) -> None:
        # Each change is an edit, after which a mode has to look at the state anew.
        if not np.array_equal(velocity, self._on_device.get(node, _REST)):
            self._state.set_pin_velocity(*node, velocity)
            self._on_device[node] = velocity


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

    def expect(self, nodes: np.ndarray, is_pinned: bool) -> None:
        """Hear that ``nodes``, (n, 2), are held or let go by another, at the end of the step."""
        # What an earlier step has left is settled.
        self.pinned_nodes()
        if self._stepping.is_mid_step:
            self._to_be.update(dict.fromkeys(map(tuple, nodes.tolist()), is_pinned))

    def _change(self, row: int, col: int, is_pinned: bool) -> None:
        self._motion.check_node(row, col)
        # What an earlier step has left is settled.
        self.pinned_nodes()
        if self._stepping.is_mid_step:
            self._to_be[row, col] = is_pinned
        change = self._motion.hold if is_pinned else self._motion.release
        self._stepping.at_rest(lambda: change(row, col))
