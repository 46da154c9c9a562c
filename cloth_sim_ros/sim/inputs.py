# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Inputs of a running cloth, one class each.

Services, topics, Python, the scene's timed entries and the replay of a recording all make these.
``apply`` checks an input and carries it out, between two steps of dt; bad values change nothing.
It returns what was accepted, in which every default has become a value, and the outcome. What was
accepted is published and recorded, and does the same when it is applied again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
from typing import Any
from typing import Protocol

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import flag
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.engine import Engines
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NameTakenError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.held.grasps import given_nodes
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.held.grasps import Grasps
from cloth_sim_ros.sim.held.pin_motion import PinMotion
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.loads.push_field import AppliedPush
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.grasp_request import GraspRequest
from cloth_sim_ros.sim.model.grid import usual_reach
from cloth_sim_ros.sim.model.pins import PinMove
from cloth_sim_ros.sim.model.pins import PinPath
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.scene import Scene
import numpy as np


class Cloth(Protocol):
    """What inputs act on: a Simulation."""

    scene: Scene
    engines: Engines
    loads: Loads
    pin_motion: PinMotion
    held: Grasps

    @property
    def time(self) -> float:
        """Return the simulated time [s]."""

    @property
    def mode(self) -> str:
        """Return the name of the mode that steps."""

    @property
    def grasps(self) -> tuple[Grasp, ...]:
        """Return the grasps that hold nodes."""

    @property
    def colliders(self) -> tuple[Collider, ...]:
        """Return the colliders where they are now."""

    def pinned_nodes(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool."""

    def positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32."""

    def begin_anew(self) -> None:
        """Carry out Reset."""

    def replace_state(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Carry out ReplaceState."""


@dataclass(frozen=True)
class PushNodes:
    """
    Push the cloth with a total force for a stretch of simulated time.

    :param starts_now: True to begin when it is accepted, whatever the start of ``push``
    """

    push: Push
    starts_now: bool = False

    def apply(self, cloth: Cloth) -> tuple[PushNodes, AppliedPush]:
        """Return the push with its start, and how many nodes it acts on."""
        push = Push.checked(**vars(
            instance(self.push, Push, 'the push', 'give what Push.checked returns')))
        if flag(self.starts_now, 'starts_now'):
            push = replace(push, start=cloth.time)
        if push.start < cloth.time:
            raise ClothSimError(
                f'the start of the push, {push.start:g} s, is in the past, the time is '
                f'{cloth.time:g} s: give a later one, or none for now')
        return PushNodes(push), cloth.loads.pushes.add(push, cloth.time)


@dataclass(frozen=True)
class ClearPushes:
    """Cancel all pushes, active and scheduled."""

    def apply(self, cloth: Cloth) -> tuple[ClearPushes, int]:
        """Return how many there were."""
        return self, cloth.loads.pushes.clear()


@dataclass(frozen=True)
class Pin:
    """Pin the node (row, col) where it is; a moving pin stops."""

    row: int
    col: int

    def apply(self, cloth: Cloth) -> tuple[Pin, None]:
        """Return no outcome."""
        row, col = _free_of_grasps(cloth, self.row, self.col)
        cloth.pin_motion.hold(row, col)
        return Pin(row, col), None


@dataclass(frozen=True)
class Unpin:
    """Release the node (row, col), with the velocity of its pin."""

    row: int
    col: int

    def apply(self, cloth: Cloth) -> tuple[Unpin, None]:
        """Return no outcome."""
        row, col = _free_of_grasps(cloth, self.row, self.col)
        cloth.pin_motion.release(row, col)
        return Unpin(row, col), None


@dataclass(frozen=True)
class MovePin:
    """
    Move the pinned node (row, col) in a straight line to a target, where it rests.

    A new target replaces the previous one, from the pin's position at that time.

    :param target: x y z [m]
    :param speed: [m/s] in simulated time; None for the scene's pin_speed
    """

    row: int
    col: int
    target: Sequence[float]
    speed: float | None = None

    @classmethod
    def of(cls, move: PinMove) -> MovePin:
        """Return the input that makes ``move``."""
        return cls(move.row, move.col, move.target, move.speed)

    def apply(self, cloth: Cloth) -> tuple[MovePin, PinPath]:
        """Return its path, with the time of arrival."""
        row, col = _free_of_grasps(cloth, self.row, self.col)
        path = cloth.pin_motion.move(row, col, self.target, self.speed, cloth.time)
        return MovePin.of(path.move), path


@dataclass(frozen=True)
class TakeGrasp:
    """
    Hold free nodes rigidly to a frame, where they are.

    :param name: of the grasp
    :param position: of the frame [m]
    :param orientation: of the frame, quaternion x y z w; None for that of the world
    :param radius: hold the nodes within it [m]
    :param count: hold that many nodes, the nearest ones; 1 where there is no radius either
    :param max_force: pull of the cloth at which it is lost [N]; 0 for never
    :param nodes: rows and columns of the nodes to hold instead of the nearest ones
    :param layers: 'all' for nodes of every layer within reach, 'top' for the highest one
    """

    name: str
    position: Sequence[float]
    orientation: Sequence[float] | None = None
    radius: float = 0.0
    count: int = 0
    max_force: float = 0.0
    nodes: Sequence[Sequence[int]] | None = None
    layers: str = ALL_LAYERS

    @classmethod
    def of(cls, grasp: Grasp) -> TakeGrasp:
        """Return the input that takes ``grasp``."""
        return cls(
            grasp.name, grasp.pose.position, grasp.pose.orientation, max_force=grasp.max_force,
            nodes=tuple((row, col) for row, col in grasp.nodes.tolist()))

    @classmethod
    def asked_by(cls, request: GraspRequest) -> TakeGrasp:
        """Return the input of a timed grasp of the scene."""
        return cls(
            request.name, request.pose.position, request.pose.orientation, request.radius,
            0 if request.radius else request.count, request.max_force, layers=request.layers)

    def apply(self, cloth: Cloth) -> tuple[TakeGrasp, Grasp]:
        """Return the grasp, with the nodes that it holds."""
        request = GraspRequest.checked(
            name=self.name, position=self.position, orientation=self.orientation,
            radius=self.radius, count=self.count, layers=self.layers, max_force=self.max_force)
        held = next((grasp for grasp in cloth.grasps if grasp.name == request.name), None)
        if held is not None:
            raise NameTakenError(
                f'grasp {request.name} holds {len(held.nodes)} nodes: release it first, or give '
                'another name')
        scene, pinned = cloth.scene, cloth.pinned_nodes()
        reach = usual_reach(scene.rows, scene.cols, scene.spacing)
        nodes = (
            request.chosen(cloth.positions(), pinned, reach, scene.cut_cells) if self.nodes is None
            else given_nodes(request.name, self.nodes, pinned, cloth.scene))
        grasp = Grasp(request.name, request.pose, nodes, request.max_force)
        cloth.held.begin(grasp)
        return TakeGrasp.of(grasp), grasp


@dataclass(frozen=True)
class Release:
    """
    Release the nodes of a grasp, with the velocity that they have.

    :param by_force: True where the cloth has pulled harder than the grasp holds
    """

    name: str
    by_force: bool = False

    def apply(self, cloth: Cloth) -> tuple[Release, Grasp]:
        """Return the nodes that the grasp held."""
        by_force = flag(self.by_force, 'by_force')
        grasp = _holding(cloth, self.name)
        cloth.held.end(grasp.name)
        return Release(grasp.name, by_force), grasp


@dataclass(frozen=True)
class MoveFrame:
    """
    Move a frame in a straight line to a target, and turn it; there it rests.

    A new target replaces the previous one, from where the frame is at that time.

    :param name: of the grasp or collider
    :param target: of its origin [m]
    :param orientation: at the target, quaternion x y z w; None for the present one
    :param speed: [m/s] in simulated time; None for the scene's motion.speed
    :param angular_speed: [rad/s]; None for the scene's motion.angular_speed
    :param duration: in which to arrive, where these speeds are high enough [s]; 0 to have these
        speeds themselves
    """

    name: str
    target: Sequence[float]
    orientation: Sequence[float] | None = None
    speed: float | None = None
    angular_speed: float | None = None
    duration: float = 0.0

    @classmethod
    def of(cls, move: FrameMove) -> Any:
        """Return the input that makes ``move``."""
        return cls(move.name, move.target, move.orientation, move.speed, move.angular_speed)

    def move(self, scene: Scene, now: float) -> FrameMove:
        """Return the move, beginning ``now`` [s], before ``duration`` slows it down."""
        return FrameMove.checked(
            name=self.name, target=self.target, orientation=self.orientation,
            speed=scene['motion.speed'] if self.speed is None else self.speed,
            angular_speed=(
                scene['motion.angular_speed'] if self.angular_speed is None
                else self.angular_speed),
            start=now)


class MoveGrasp(MoveFrame):
    """Move a grasp."""

    def apply(self, cloth: Cloth) -> tuple[MoveGrasp, FramePath]:
        """Return its path, with the time of arrival."""
        move = self.move(cloth.scene, cloth.time)
        grasp = _holding(cloth, self.name)
        path = cloth.held.move(move.slowed(self.duration, grasp.pose))
        return MoveGrasp.of(path.move), path


class MoveCollider(MoveFrame):
    """Move a collider."""

    def apply(self, cloth: Cloth) -> tuple[MoveCollider, FramePath]:
        """Return its path, with the time of arrival."""
        move = self.of_one(cloth.scene, cloth.colliders, cloth.time)
        contacts = cloth.loads.contacts
        assert contacts is not None  # there would be no collider
        path = contacts.move(move)
        return MoveCollider.of(path.move), path

    def of_one(self, scene: Scene, colliders: Sequence[Collider], now: float) -> FrameMove:
        """
        Return the move, beginning ``now`` [s].

        :param colliders: of the scene, where they are now
        """
        poses = {collider.name: collider.pose for collider in colliders}
        if not isinstance(self.name, str) or self.name not in poses:
            raise NotFoundError(
                f'there is no collider {shown(self.name)}: give one of those of the scene, '
                f'{", ".join(poses) or "none"}')
        return self.move(scene, now).slowed(self.duration, poses[self.name])


@dataclass(frozen=True)
class SetWind:
    """Replace the steady wind by ``velocity`` [m/s]; gusts of the scene stay."""

    velocity: Sequence[float]

    def apply(self, cloth: Cloth) -> tuple[SetWind, None]:
        """Return no outcome."""
        wind = cloth.loads.checked_wind(self.velocity)
        cloth.loads.set_wind(wind)
        return SetWind(wind), None


@dataclass(frozen=True)
class SetMode:
    """
    Step with ``mode`` from now on, keeping the state.

    :param previous: in what was accepted, the mode before, which can be the same
    """

    mode: str
    previous: str = ''

    def apply(self, cloth: Cloth) -> tuple[SetMode, str]:
        """Return the mode before."""
        previous = cloth.mode
        cloth.engines.use(self.mode)
        return SetMode(self.mode, previous), previous


@dataclass(frozen=True)
class Reset:
    """Go back to the start: pose, pins, time, and all that is timed in the scene."""

    def apply(self, cloth: Cloth) -> tuple[Reset, None]:
        """Return no outcome."""
        cloth.begin_anew()
        return self, None


@dataclass(frozen=True, eq=False)
class ReplaceState:
    """
    Replace positions [m] and velocities [m/s], both (rows, cols, 3).

    Pins are at rest then: moves in progress end, pending ones of the scene stay.
    """

    positions: np.ndarray
    velocities: np.ndarray

    def apply(self, cloth: Cloth) -> tuple[ReplaceState, None]:
        """Return no outcome."""
        cloth.replace_state(self.positions, self.velocities)
        return self, None


Input = (
    PushNodes | ClearPushes | Pin | Unpin | MovePin | TakeGrasp | Release | MoveGrasp
    | MoveCollider | SetWind | SetMode | Reset | ReplaceState)


class InputListener:
    """Is notified of the inputs of a Simulation; a no-op base class."""

    def check(self, given: Input) -> None:
        """Look at an input that is about to be applied; raise ClothSimError to refuse it."""

    def accept(self, given: Input, time: float) -> None:
        """Note an input that was accepted, and acts from the simulated ``time`` [s] on."""


def _free_of_grasps(cloth: Cloth, row: int, col: int) -> tuple[int, int]:
    """Return ``row`` and ``col`` as ints; ClothSimError for no node, or one that a grasp holds."""
    row, col = cloth.scene.checked_node(row, col)
    for grasp in cloth.grasps:
        if np.any(np.all(grasp.nodes == (row, col), axis=-1)):
            raise WrongStateError(
                f'grasp {grasp.name} holds node ({row}, {col}): move or release the grasp')
    return row, col


def _holding(cloth: Cloth, name: str) -> Grasp:
    """Return the grasp ``name``, or raise ClothSimError when it holds nothing."""
    present = {grasp.name: grasp for grasp in cloth.grasps}
    if not isinstance(name, str) or name not in present:
        names = ', '.join(present) or 'none'
        raise NotFoundError(
            f'there is no grasp {shown(name)}: grasp first, or give one of those that hold '
            f'nodes, {names}')
    return present[name]
