# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of the node's own pins, grasps and colliders, which it need not hear of from /tf."""

from collections import deque
from collections.abc import Iterator

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.frame_names import collider_frame
from cloth_sim_ros.messages.frame_names import grasp_frame
from cloth_sim_ros.messages.frame_names import node_of_pin
from cloth_sim_ros.messages.frame_names import pin_frame
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.node.frame_history import FrameHistory
from cloth_sim_ros.node.frame_history import KEPT
from cloth_sim_ros.node.frame_history import MOST_SAMPLES
from cloth_sim_ros.node.frame_history import Sample
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np


class OwnFrames:
    """
    Where the frames are now, and were in the frames of the last seconds that were sent.

    :param node_name: with its namespace
    :param frame_id: of the cloth, their parent
    """

    def __init__(self, simulation: Simulation, node_name: str, frame_id: str) -> None:
        """Begin with the present."""
        self._simulation = simulation
        self._node_name = node_name
        self._frame_id = frame_id
        self._prefixes = tuple(
            name(node_name, '') for name in (grasp_frame, collider_frame, _pins_frame))
        self._bodies: dict[str, FrameHistory] = {}
        # Time [ns], the pins as indices of nodes, and their positions (pins, 3).
        self._pins: deque[tuple[int, np.ndarray, np.ndarray]] = deque(maxlen=MOST_SAMPLES)

    def owns(self, frame: str) -> bool:
        """Tell whether the name ``frame`` is one of those that the node gives."""
        return frame.startswith(self._prefixes)

    def note_bodies(self) -> None:
        """Remember where grasps and colliders are now."""
        now, poses = nanoseconds(self._simulation.time), self._body_poses()
        self._bodies = {name: self._bodies.get(name, FrameHistory()) for name in poses}
        for name, pose in poses.items():
            self._add(self._bodies[name], now, pose)

    def note_pins(self, snapshot: Snapshot) -> None:
        """Remember where pins are in ``snapshot``."""
        now = nanoseconds(snapshot.time)
        nodes = np.flatnonzero(self._pinned())
        while self._pins and not now - KEPT <= self._pins[0][0] <= now:
            self._pins.popleft()
        self._pins.append((now, nodes, snapshot.positions.reshape(-1, 3)[nodes]))

    def forget(self) -> None:
        """Forget what was: the time has gone back."""
        self._bodies.clear()
        self._pins.clear()

    def history(self, frame: str) -> FrameHistory | None:
        """
        Return where ``frame`` was, and is; None for a frame that is none of the node's own.

        :raises ClothSimError: for one that the node could have, and does not have now
        """
        if not self.owns(frame):
            return None
        now, pose = nanoseconds(self._simulation.time), self._body_poses().get(frame)
        if pose is not None:
            history = self._bodies.setdefault(frame, FrameHistory())
            self._add(history, now, pose)
            return history
        node = self._pin(frame)
        if node is None:
            raise ClothSimError(
                f'the frame {shown(frame)} would be of a grasp, a collider or a pin of this node '
                'that is not there: grasp or pin first, or give another frame')
        history = FrameHistory()
        for time, position in self._places(node[0] * self._simulation.scene.cols + node[1]):
            self._add(history, time, _at(position))
        self._add(history, now, _at(self._simulation.positions()[node]))
        return history

    def _add(self, history: FrameHistory, now: int, pose: Pose) -> None:
        # While the time stands still, the present can be another one than it was.
        history.drop_from(now)
        history.add(Sample(now, self._frame_id, pose))

    def _body_poses(self) -> dict[str, Pose]:
        simulation = self._simulation
        return body_poses(self._node_name, simulation.grasps, simulation.colliders)

    def _pin(self, frame: str) -> tuple[int, int] | None:
        """Return row and col of the pin of that name; None when there is none now."""
        node, scene = node_of_pin(frame), self._simulation.scene
        if node is None or pin_frame(self._node_name, *node) != frame:
            return None
        is_there = node[0] < scene.rows and node[1] < scene.cols and self._pinned()[node]
        return node if is_there else None

    def _pinned(self) -> np.ndarray:
        return self._simulation.pinned_nodes() & ~self._simulation.grasped_nodes()

    def _places(self, node: int) -> Iterator[tuple[int, np.ndarray]]:
        """Yield when and where ``node`` was a pin, for as long as it is one."""
        found = []
        for time, nodes, positions in reversed(self._pins):
            at = int(np.searchsorted(nodes, node))
            if at == len(nodes) or nodes[at] != node:
                break
            found.append((time, positions[at]))
        yield from reversed(found)


def _at(position: np.ndarray) -> Pose:
    x, y, z = map(float, position)
    return Pose((x, y, z))


def _pins_frame(node_name: str, _: str) -> str:
    return pin_frame(node_name, 0, 0).removesuffix('0_0')
