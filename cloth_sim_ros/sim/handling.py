# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is done to a running cloth from outside, and who is told of it."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Sequence
from contextlib import AbstractContextManager

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.frame_paths import FramePath
from cloth_sim_ros.sim.frame_paths import MovedFrame
from cloth_sim_ros.sim.grasp_request import GraspRequest
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.grasps import GraspRequests
from cloth_sim_ros.sim.grasps import Grasps
from cloth_sim_ros.sim.grid import near_node
from cloth_sim_ros.sim.grid import NearNode
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.pin_motion import PinRequests
from cloth_sim_ros.sim.pins import checked_node
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.pins import PinPath
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.push_field import AppliedPush
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stepping import RunStatus
import numpy as np

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


# Find the node of a running cloth at a point.

USUAL_REACH = 0.1  # [m], as far as a click pushes


def nearest(
        scene: Scene, positions: np.ndarray, point: Sequence[float],
        max_distance: float | None = None, pinned: np.ndarray | None = None) -> NearNode:
    """
    Return the node nearest to ``point`` [m]; see near_node.

    :param max_distance: [m], by default usual_reach
    """
    if max_distance is None:
        max_distance = usual_reach(scene)
    return near_node(positions, point, max_distance, pinned)


def usual_reach(scene: Scene) -> float:
    """Return how far a node may be from a point that means it [m]: further on a coarse cloth."""
    dx, dy = scene.spacing
    return max(USUAL_REACH, dx if scene.cols > 1 else 0.0, dy if scene.rows > 1 else 0.0)


class Handling(RunStatus, ABC):
    """
    The part of a Simulation that takes requests.

    Each is checked at once. Between pieces of a step it is carried out at the end of that step,
    at ``stepping.edit_time``.
    """

    scene: Scene
    listener: InputListener
    _pins: PinRequests
    _pin_motion: PinMotion
    _grasps: GraspRequests
    _held: Grasps

    # What is asked of a cloth depends on where it is.
    @abstractmethod
    def positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32."""

    @abstractmethod
    def _settled_state(self) -> AbstractContextManager[None]:
        """Return what has the state of the end of a step in place of one within it."""

    @property
    def pushes(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return self.loads.pushes.applied

    def push(
            self, force: Sequence[float], *, duration: float, region: str = 'all',
            center: Sequence[float] = (0.0, 0.0, 0.0), radius: float = 0.0,
            start: float | None = None) -> AppliedPush:
        """
        Push the cloth with a total ``force`` [N] for ``duration`` [s] of simulated time.

        :param region: all, or sphere: the free nodes within ``radius`` of ``center`` [m]
            when the push begins; one to come that finds none does nothing
        :param start: simulated time at which it begins [s]; now by default
        :raises ClothSimError: when a value is wrong or no free node is in the region
        """
        push = Push.checked(
            force=force, start=self.stepping.edit_time if start is None else start,
            duration=duration, region=region, center=center, radius=radius)
        begin = push.start
        if begin < self.time:
            raise ClothSimError(
                f'the start of the push, {begin:g} s, is in the past, the time is {self.time:g} '
                's: give a later one, or none for now')
        with self._settled_state():
            if self.stepping.is_mid_step and begin <= self.stepping.edit_time:
                applied = self.loads.pushes.foresee(push, self.pinned_nodes())
                self.stepping.at_rest(lambda: self.loads.pushes.begin(push))
            else:
                applied = self.loads.pushes.add(push, self.time)
        self.listener.push(push)
        return applied

    def clear_pushes(self) -> int:
        """Cancel all active and scheduled pushes; return how many."""
        self.listener.command(CLEAR_PUSHES)
        pushes = [applied.push for applied in self.pushes]
        self.stepping.at_rest(lambda: self.loads.pushes.drop(pushes))
        return len(pushes)

    def set_wind(self, velocity: Sequence[float]) -> None:
        """Replace the steady wind by ``velocity`` [m/s]; gusts of the scene stay."""
        wind = self.loads.checked_wind(velocity)
        self.stepping.at_rest(lambda: self.loads.set_wind(wind))
        self.listener.wind(wind)

    def pin(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is; a moving pin stops."""
        row, col = self._free_of_grasps(row, col)
        self._pins.hold(row, col)
        self.listener.pin(row, col, True)

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col), with the velocity of its pin."""
        row, col = self._free_of_grasps(row, col)
        self._pins.release(row, col)
        self.listener.pin(row, col, False)

    def move_pin(
            self, row: int, col: int, target: Sequence[float],
            speed: float | None = None) -> PinPath:
        """
        Move the pinned node (row, col) in a straight line to ``target`` [m], where it rests.

        A new target replaces the previous one, from the pin's position at that time.

        :param speed: [m/s] in simulated time; the scene's pin_speed by default
        :return: its path, with the time of arrival
        :raises ClothSimError: when the node is not pinned or a value is wrong
        """
        row, col = self._free_of_grasps(row, col)
        path = self._pins.move(row, col, target, speed)
        self.listener.pin_target(path.move)
        return path

    @property
    def pin_moves(self) -> tuple[PinMove, ...]:
        """Return the moves of pins that are under way."""
        return self._pin_motion.under_way

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool, with changes yet to be made."""
        return self._pins.pinned_nodes()

    def nearest_node(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the node nearest to ``point`` [m]."""
        return nearest(self.scene, self.positions(), point, max_distance)

    def nearest_pin(
            self, point: Sequence[float], max_distance: float | None = None) -> NearNode:
        """Return the pinned node nearest to ``point`` [m]."""
        return nearest(self.scene, self.positions(), point, max_distance, self.pinned_nodes())

    @property
    def grasps(self) -> tuple[Grasp, ...]:
        """Return the grasps that hold nodes, with changes yet to be made."""
        return tuple(self._grasps.present().values())

    def grasped_nodes(self) -> np.ndarray:
        """Return which nodes grasps hold, (rows, cols) bool, with changes yet to be made."""
        held = np.zeros((self.scene.rows, self.scene.cols), dtype=bool)
        for grasp in self.grasps:
            held[tuple(grasp.nodes.T)] = True
        return held

    def grasp(
            self, name: str, position: Sequence[float],
            orientation: Sequence[float] | None = None, *, radius: float = 0.0, count: int = 0,
            max_force: float = 0.0, nodes: Sequence[Sequence[int]] | None = None) -> Grasp:
        """
        Hold free nodes rigidly to a frame at ``position`` [m], where they are.

        :param name: of the grasp
        :param orientation: of its frame, quaternion x y z w; that of the world by default
        :param radius: hold the nodes within it [m]
        :param count: hold that many nodes, the nearest ones; 1 where there is no radius either
        :param max_force: pull of the cloth at which it is lost [N]; 0 for never
        :param nodes: rows and columns of the nodes to hold in place of the nearest ones
        :raises ClothSimError: when the name holds nodes, a value is wrong or no node is there
        """
        request = GraspRequest.checked(
            name=name, position=position, orientation=orientation, radius=radius, count=count,
            max_force=max_force)
        self.engines.context.make_current()
        grasp = self._grasps.begin(request, self.positions(), nodes)
        self.listener.grasp(grasp)
        return grasp

    def release_grasp(self, name: str) -> Grasp:
        """Let the nodes of a grasp go, with the velocity that they have; return what it held."""
        self.engines.context.make_current()
        grasp = self._grasps.end(name)
        self.listener.grasp_release(name, False)
        return grasp

    def move_grasp(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None = None,
            speed: float | None = None, angular_speed: float | None = None, *,
            duration: float = 0.0) -> FramePath:
        """
        Move a grasp in a straight line to ``target`` [m], and turn it; there it rests.

        A new target replaces the previous one, from where the grasp is at that time.

        :param orientation: at the target, quaternion x y z w; the present one by default
        :param speed: [m/s] in simulated time; the scene's motion.speed by default
        :param angular_speed: [rad/s]; the scene's motion.angular_speed by default
        :param duration: in which to arrive, where these speeds are high enough [s]; 0 to have
            these speeds themselves
        :return: its path, with the time of arrival
        :raises ClothSimError: when it holds nothing or a value is wrong
        """
        self.engines.context.make_current()
        move = self._frame_move(name, target, orientation, speed, angular_speed)
        move = move.slowed(duration, self._grasps.foresee(move).origin)
        path = self._grasps.move(move)
        self.listener.grasp_move(path.move)
        return path

    def move_collider(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None = None,
            speed: float | None = None, angular_speed: float | None = None, *,
            duration: float = 0.0) -> FramePath:
        """Move a collider as ``move_grasp`` does a grasp."""
        contacts = self.loads.contacts
        names = [collider.name for collider in self.colliders]
        if contacts is None or not isinstance(name, str) or name not in names:
            raise ClothSimError(
                f'there is no collider {shown(name)}: give one of those of the scene, '
                f'{", ".join(names) or "none"}')
        move = self._frame_move(name, target, orientation, speed, angular_speed)
        move = move.slowed(duration, contacts.path_of(move).origin)
        path = contacts.path_of(move)
        self.stepping.at_rest(lambda: contacts.move(move))
        self.listener.collider_move(move)
        return path

    @property
    def grasp_paths(self) -> tuple[FramePath, ...]:
        """Return the paths of grasps that are under way."""
        return self._held.under_way(self.time)

    @property
    def moved_colliders(self) -> tuple[MovedFrame, ...]:
        """Return the colliders that are not where the scene alone has them."""
        contacts = self.loads.contacts
        return () if contacts is None else contacts.moved(self.time)

    def _free_of_grasps(self, row: int, col: int) -> tuple[int, int]:
        """Return row and col as ints; ClothSimError when a grasp holds the node, or none is."""
        row, col = checked_node(row, col, self.scene.rows, self.scene.cols)
        self.engines.context.make_current()
        self._grasps.refuse_held(row, col)
        return row, col

    def _frame_move(
            self, name: str, target: Sequence[float], orientation: Sequence[float] | None,
            speed: float | None, angular_speed: float | None) -> FrameMove:
        return FrameMove.checked(
            name=name, target=target, orientation=orientation,
            speed=self.scene['motion.speed'] if speed is None else speed,
            angular_speed=(
                self.scene['motion.angular_speed'] if angular_speed is None else angular_speed),
            start=self.stepping.edit_time)
