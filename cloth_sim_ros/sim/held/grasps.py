# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps: nodes that are held rigidly to a frame, which can be moved and turned."""

from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace

from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.held.pin_motion import PinMotion
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.model.frame_paths import FramePaths
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.state import State
import numpy as np


@dataclass(frozen=True)
class Grasp:
    """
    Nodes that are held.

    :param name: of the grasp
    :param pose: of its frame now
    :param nodes: their rows and columns, (n, 2)
    :param max_force: pull of the cloth at which it is lost [N]; 0 for never
    """

    name: str
    pose: Pose
    nodes: np.ndarray
    max_force: float


@dataclass(frozen=True)
class GraspForce:
    """
    What a gripper feels: the force of the cloth on it.

    :param name: of the grasp
    :param force: the mean over the last step of dt, or over a frame [N], (3,)
    :param torque: the same about the origin of its frame [N m], (3,)
    :param peak: the force in the substep in which it was strongest [N], (3,)
    """

    name: str
    force: np.ndarray
    torque: np.ndarray
    peak: np.ndarray


class Grasps:
    """
    The grasps of a run; each of their nodes is a pin that follows its frame.

    :param state: whose nodes are held
    :param pins: which move them
    """

    def __init__(self, state: State, pins: PinMotion) -> None:
        """Begin without any."""
        self._state = state
        self._pins = pins
        self._held: dict[str, Grasp] = {}
        self._paths = FramePaths({})

    def present(self, now: float) -> tuple[Grasp, ...]:
        """Return those that hold something ``now`` [s]."""
        return tuple(
            replace(grasp, pose=self._paths.pose(name, now))
            for name, grasp in self._held.items())

    @property
    def can_be_lost(self) -> bool:
        """Return whether one of them holds no more than a force."""
        return any(grasp.max_force for grasp in self._held.values())

    def under_way(self, now: float) -> tuple[FramePath, ...]:
        """Return the paths of those that move."""
        return self._paths.under_way(now)

    def mark(self, flags: np.ndarray) -> None:
        """Set FLAG_GRASPED in the ``flags`` of nodes, (rows, cols), where they are held."""
        for grasp in self._held.values():
            flags[tuple(grasp.nodes.T)] |= FLAG_GRASPED

    def begin(self, grasp: Grasp) -> None:
        """Hold the nodes of ``grasp``, which are free, where they are."""
        for row, col in grasp.nodes.tolist():
            self._pins.hold(row, col)
        self._held[grasp.name] = grasp
        self._paths.put(grasp.name, grasp.pose)

    def holds(self, name: str) -> bool:
        """Return whether the grasp ``name`` holds nodes."""
        return name in self._held

    def end(self, name: str) -> None:
        """Release the nodes of a grasp, with the velocity that they have."""
        for row, col in self._held.pop(name).nodes.tolist():
            self._pins.release(row, col)
        self._paths.drop(name)

    def move(self, move: FrameMove) -> FramePath:
        """Start the motion of a grasp that holds nodes; return its path."""
        path = self._paths.add(move)
        nodes = self._held[move.name].nodes.tolist()
        here = np.array([self._pins.position(row, col, move.start) for row, col in nodes])
        arms = path.origin.seen_from(here)
        for (row, col), arm in zip(nodes, arms):
            self._pins.follow(row, col, CarriedNode(path, arm))
        return path

    def stop(self, now: float) -> None:
        """Have their frames at rest where they are: their nodes have been put elsewhere."""
        for grasp in self.present(now):
            self._paths.put(grasp.name, grasp.pose)


def given_nodes(
        name: str, nodes: Sequence[Sequence[int]], pinned: np.ndarray,
        scene: Scene) -> np.ndarray:
    """Return ``nodes`` as (n, 2), or raise ClothSimError where they can't be held."""
    chosen = integers(nodes, f'the nodes of grasp {name}', 'give [row, col] of each')
    if not chosen.size:
        raise ClothSimError(f'grasp {name} has no node: give some, or a radius')
    if chosen.ndim != 2 or chosen.shape[1] != 2:
        raise ClothSimError(
            f'the nodes of grasp {name} must be (n, 2), got {chosen.shape}: give [row, col] of '
            'each')
    for row, col in chosen.tolist():
        scene.checked_node(row, col)
        if pinned[row, col]:
            raise WrongStateError(
                f'grasp {name} cannot have node ({row}, {col}), which is pinned: release it '
                'first')
    return np.unique(chosen, axis=0)


class CarriedNode:
    """
    The path of a node that a frame carries.

    :param path: of the frame
    :param arm: where the node is in the frame [m], (3,)
    """

    def __init__(self, path: FramePath, arm: np.ndarray) -> None:
        """Follow the frame until it arrives."""
        self._path = path
        self._arm = arm
        self.begin = path.begin
        self.arrival = path.arrival

    def position(self, time: float) -> np.ndarray:
        """Return where the node is at ``time`` [s], (3,) [m]."""
        return self._path.pose(time).in_world(self._arm)

    def velocity(self, begin: float, end: float, at_begin: np.ndarray) -> np.ndarray:
        """Return what takes it from ``at_begin`` at ``begin`` to its place at ``end`` [m/s]."""
        if not self._path.turns and self._path.is_under_way(begin, end):
            return self._path.velocity
        return (self.position(end) - at_begin) / (end - begin)
