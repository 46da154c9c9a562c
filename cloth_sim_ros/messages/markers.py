# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth and the colliders as markers, as serialised bytes."""

from collections.abc import Iterable
from collections.abc import Sequence
from typing import Any

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.cdr_writer import ENCAPSULATION
from cloth_sim_ros.messages.geometry import MOST_DRAWN
from cloth_sim_ros.messages.geometry import push_arrows
from cloth_sim_ros.messages.geometry import strain_colors
from cloth_sim_ros.messages.geometry import Surface
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
from visualization_msgs.msg import Marker

COLOR = (0.55, 0.58, 0.62, 1.0)
# How far a plane is shown, in lengths of the cloth, and how thick [m].
_PLANE_SIDE, _PLANE_THICKNESS = 6.0, 1e-3


def collider_markers(colliders: Sequence[Collider], cloth_size: float) -> list[dict[str, Any]]:
    """
    Return the markers of ``colliders`` as put_marker takes them.

    :param cloth_size: length of the longer side of the cloth [m], which planes are shown by
    """
    return [
        {'namespace': f'collider/{collider.name}', 'number': number, 'color': COLOR, **part}
        for collider in colliders
        for number, part in enumerate(_parts(collider, cloth_size))]


def _parts(collider: Collider, cloth_size: float) -> list[dict[str, Any]]:
    position = np.array(collider.position)
    at = {'position': collider.position, 'orientation': collider.orientation}
    if collider.shape == 'plane':
        side = _PLANE_SIDE * cloth_size
        below = position - 0.5 * _PLANE_THICKNESS * collider.axes[2]
        return [{**at, 'position': _point(below), 'kind': Marker.CUBE,
                 'scale': (side, side, _PLANE_THICKNESS)}]
    if collider.shape == 'box':
        return [{**at, 'kind': Marker.CUBE, 'scale': collider.size}]
    width = 2.0 * collider.size[0]
    ball = {**at, 'kind': Marker.SPHERE, 'scale': (width, width, width)}
    if collider.shape == 'sphere':
        return [ball]
    length = collider.size[1]
    middle = {**at, 'kind': Marker.CYLINDER, 'scale': (width, width, length)}
    if collider.shape == 'cylinder':
        return [middle]
    ends = [
        {**ball, 'position': _point(position + side * 0.5 * length * collider.axes[2])}
        for side in (-1.0, 1.0)]
    return [middle, *ends]


def _point(position: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in position)
    return x, y, z


# The cloth as markers, already in the bytes that go out.

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_NO_POINTS = np.empty((0, 3))
_NO_COLORS = np.empty((0, 4), '<f4')
PIN_COLOR = (0.9, 0.1, 0.1, 1.0)
LIMIT_COLOR = (1.0, 0.45, 0.0, 1.0)
PUSH_COLOR = (0.1, 0.4, 1.0, 1.0)
GRASP_COLOR = (0.9, 0.1, 0.1, 0.5)


def put_marker(
        writer: CdrWriter, *, time: Time, frame_id: str, namespace: str, number: int,
        action: int = Marker.ADD, kind: int = 0,
        scale: tuple[float, float, float] = (0.0, 0.0, 0.0),
        color: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
        points: np.ndarray = _NO_POINTS, colors: np.ndarray = _NO_COLORS,
        position: tuple[float, float, float] = (0.0, 0.0, 0.0),
        orientation: tuple[float, float, float, float] = _NO_TURN) -> None:
    """
    Put a visualization_msgs/Marker.

    :param kind: Marker.TRIANGLE_LIST and so on
    :param points: (n, 3) float64
    :param colors: (n, 4) float32, or empty for ``color`` everywhere
    :param position: of the marker, to which points are relative [m]
    :param orientation: quaternion x y z w
    """
    _put_header(writer, time, frame_id)
    writer.put_string(namespace)
    writer.put('i', number, kind, action)
    writer.put('d', *position, *orientation, *scale)
    writer.put('f', *color)
    writer.put_bytes(_LIFETIME, 4)
    writer.put_sequence(points)
    writer.put_sequence(colors)
    writer.put_bytes(_TAIL, 4)


def _tail() -> bytes:
    """Return what is behind the colours of each marker, without an encapsulation."""
    writer = CdrWriter()
    writer.put_string('')  # texture_resource
    _put_header(writer, Time(), '')  # texture
    writer.put_string('')
    writer.put('I', 0)
    writer.put('I', 0)  # uv_coordinates
    writer.put_string('')  # text
    writer.put_string('')  # mesh_resource
    writer.put_string('')  # mesh_file
    writer.put('I', 0)
    writer.put('?', False)  # mesh_use_embedded_materials
    return writer.finish()[len(ENCAPSULATION):]


def _put_header(writer: CdrWriter, time: Time, frame_id: str) -> None:
    writer.put('i', time.sec)
    writer.put('I', time.nanosec)
    writer.put_string(frame_id)


# Nothing in it is aligned to more than its beginning is: 4 bytes.
_TAIL = _tail()
# lifetime, for ever, and frame_locked, which is false.
_LIFETIME = bytes(4 + 4 + 1)


class MarkersMessage:
    """
    MarkerArray of one cloth: surface coloured by strain, pins, limits, pushes, grasps, colliders.

    Each marker keeps its namespace and number. One that has gone is deleted in every message
    from then on, so that a viewer which missed a message does not keep it.

    :param frame_id: frame of the positions
    :param max_side: nodes drawn along each side at most; larger cloths are sampled evenly
    :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
    """

    def __init__(
            self, rows: int, cols: int, frame_id: str, max_side: int = MOST_DRAWN,
            present: np.ndarray | None = None) -> None:
        """Choose the nodes drawn."""
        self._frame_id = frame_id
        self._surface = Surface(rows, cols, max_side, present)
        self._cells = max(rows, cols) - 1
        self._is_whole = present is None
        self._shown: set[tuple[str, int]] = set()

    def serialise(
            self, snapshot: Snapshot, pushes: Iterable[Push] = (),
            colliders: Sequence[Collider] = (), grasps: Sequence[Grasp] = (),
            epoch: int = 0) -> bytes:
        """
        Return the CDR bytes of the MarkerArray.

        :param pushes: those that act
        :param colliders: where they are now
        :param grasps: those that hold nodes
        :param epoch: stamp of simulated time 0 [ns]
        """
        size = _size(snapshot.positions, self._is_whole)
        # Half the distance of nodes, but still to be seen on a fine cloth.
        node_size = size * max(0.5 / self._cells, 0.01)
        markers = self._markers(snapshot, pushes, size, node_size)
        for number, grasp in enumerate(grasps):
            markers.append({
                'namespace': 'grasps', 'number': number, 'kind': Marker.CUBE,
                'scale': (2.0 * node_size,) * 3, 'color': GRASP_COLOR,
                'position': grasp.pose.position, 'orientation': grasp.pose.orientation})
        if colliders:
            markers += collider_markers(colliders, size)
        shown = {(marker['namespace'], marker['number']) for marker in markers}
        self._shown |= shown
        markers += [
            {'namespace': namespace, 'number': number, 'action': Marker.DELETE}
            for namespace, number in sorted(self._shown - shown)]
        writer = CdrWriter()
        writer.put('I', len(markers))
        time = stamp(snapshot.time, epoch)
        for marker in markers:
            put_marker(writer, time=time, frame_id=self._frame_id, **marker)
        return writer.finish()

    def _markers(
            self, snapshot: Snapshot, pushes: Iterable[Push], size: float,
            node_size: float) -> list[dict[str, Any]]:
        drawn = self._surface.sample(snapshot.positions)
        markers = [self._cloth(drawn, snapshot.strain, node_size)]
        flags = np.ascontiguousarray(snapshot.flags)
        pins = _nodes(snapshot.positions, flags & FLAG_PINNED)
        if len(pins):
            markers.append({
                'namespace': 'pins', 'number': 0, 'kind': Marker.SPHERE_LIST,
                'scale': (node_size,) * 3, 'color': PIN_COLOR, 'points': pins})
        limits = _nodes(snapshot.positions, flags & FLAG_AT_LIMIT)
        if len(limits):
            markers.append({
                'namespace': 'active_constraints', 'number': 0, 'kind': Marker.POINTS,
                'scale': (node_size, node_size, 0.0), 'color': LIMIT_COLOR, 'points': limits})
        arrows = push_arrows(pushes, snapshot.time, drawn, 0.3 * size)
        markers += [
            {'namespace': 'pushes', 'number': number, 'kind': Marker.ARROW,
             'scale': (0.02 * size, 0.05 * size, 0.0), 'color': PUSH_COLOR, 'points': arrow}
            for number, arrow in enumerate(arrows)]
        return markers

    def _cloth(self, drawn: np.ndarray, strain: np.ndarray, node_size: float) -> dict[str, Any]:
        is_chain = self._surface.is_chain
        return {
            'namespace': 'surface', 'number': 0,
            'kind': Marker.LINE_STRIP if is_chain else Marker.TRIANGLE_LIST,
            'scale': (0.5 * node_size, 0.0, 0.0) if is_chain else (1.0, 1.0, 1.0),
            'color': (1.0, 1.0, 1.0, 1.0),
            'points': self._surface.points(drawn),
            'colors': self._surface.colors(strain_colors(self._surface.sample(strain)))}


def _size(positions: np.ndarray, is_whole: bool) -> float:
    """
    Return the longer side [m], along the first row or the first column as they hang.

    Of a cloth that is not whole, along the longest row or column.
    """
    some = np.s_[:1] if is_whole else np.s_[:]
    lengths = (
        np.linalg.norm(np.diff(lines.astype(float), axis=1), axis=2)
        for lines in (positions[some], positions[:, some].swapaxes(0, 1)))
    return max(float(np.nansum(each, axis=1).max()) for each in lengths)


def _nodes(positions: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the ``positions`` where ``chosen`` is not 0, (n, 3) float64."""
    return positions[chosen != 0].astype('<f8')
