# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scene of a page: the cloth, handles at its pins, and colliders."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.strain_stops import strain_rgb
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.model.collider_surface import ground
from cloth_sim_ros.sim.model.collider_surface import local_surface
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.surface import band_colors
from cloth_sim_ros.view.surface import Surface
import numpy as np
import viser

_PIN_COLOR = (220, 40, 40)
_GRASP_COLOR = (143, 51, 184)
# Size of a pin's dot over the diagonal of the cloth [1].
_PIN_SIZE = 0.012
# Props of a mesh that shows nothing: viser takes no empty one.
_NO_VERTICES = np.zeros((3, 3), np.float32)
_NO_FACES = np.array([[0, 1, 2]], np.uint32)


class ClothDrawing:
    """A mesh for each band of strain, and a dot for each pin; a chain of nodes has dots alone."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Add the bands, without triangles."""
        self._scene = server.scene
        self.surface = Surface(1, 2)
        self.full_strain = 0.0
        self._shape: tuple[int, int] = (0, 0)
        self._size = 0.0
        self._bands = [
            self._scene.add_mesh_simple(
                f'/cloth/strain_{band}', _NO_VERTICES, _NO_FACES, color=color, side='double',
                # A thin sheet would be striped by its own shadow.
                receive_shadow=False, visible=False)
            for band, color in enumerate(band_colors())]

    def draw(self, frame: Frame, full_strain: float) -> None:
        """
        Show the cloth as it is in ``frame``.

        :param full_strain: that the last colour stands for
        """
        rows, cols = frame.strain.shape
        if self._shape != (rows, cols) or not np.array_equal(frame.cells, self.surface.cells):
            self._shape = rows, cols
            self.surface = Surface(rows, cols, frame.cells)
            self._size = _PIN_SIZE * diagonal(frame)
        self.full_strain = full_strain
        for handle, mesh in zip(self._bands, self.surface.bands(frame, full_strain)):
            handle.visible = mesh is not None
            if mesh is not None:
                handle.vertices, handle.faces = mesh
        if not len(self.surface.faces):
            colors = strain_rgb(self.surface.strain(frame) / full_strain)
            self._add_dots('/cloth/nodes', self.surface.points(frame), colors)
        for name, nodes, color in (
                ('pins', frame.pinned & ~frame.grasped, _PIN_COLOR),
                ('grasped', frame.grasped, _GRASP_COLOR)):
            self._add_dots(f'/cloth/{name}', frame.positions[nodes].astype(np.float32), color)

    def _add_dots(
            self, name: str, points: np.ndarray,
            colors: np.ndarray | tuple[int, int, int]) -> None:
        # Added anew each time, as their number changes.
        self._scene.add_point_cloud(
            name, points, colors, point_size=self._size, point_shape='circle',
            precision='float32', visible=len(points) > 0)


def diagonal(frame: Frame) -> float:
    """Return that of the box along the axes that the cloth is in [m]."""
    return float(np.linalg.norm(np.ptp(frame.positions[frame.present], axis=0)))


# The floor and the lamp.

_FLOOR_COLOR = (243, 241, 238)
_GRID_COLOR = (204, 204, 204)
# From the lowest node to the floor, and how far the floor reaches, in diagonals of the cloth.
_BELOW, _FLOOR = 0.08, 8.0
# Cells of the floor along a diagonal.
_CELLS = 4
# Towards the lamp: to the left of where a page first looks from, and above.
_LAMP = np.array((-0.7, -1.0, 1.0))
_LAMP_INTENSITY, _SKY_INTENSITY = 2.8, 1.3
_SKY, _GROUND = (255, 255, 255), (205, 200, 195)


def draw_surroundings(
        scene: viser.SceneApi, positions: np.ndarray, colliders: tuple[Collider, ...]) -> None:
    """
    Add a lamp and, where no level plane is one, a floor below the cloth.

    :param positions: of the cloth as it is first shown, (..., 3) [m]
    """
    points = positions.reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1)]
    size = max(float(np.linalg.norm(np.ptp(points, axis=0))), 1e-3) if len(points) else 1.0
    middle = points.mean(axis=0) if len(points) else np.zeros(3)
    # Its own lights would be added to these, and leave no shade in folds.
    scene.configure_default_lights(False)
    scene.configure_environment_map(None)
    scene.add_light_hemisphere(
        '/lights/sky', sky_color=_SKY, ground_color=_GROUND, intensity=_SKY_INTENSITY)
    scene.add_light_directional(
        '/lights/lamp', intensity=_LAMP_INTENSITY, cast_shadow=True,
        position=tuple((middle + 2.0 * size * _LAMP).tolist()))
    level = ground(colliders)
    if level is None:
        hangs = float(points[:, 2].min()) if len(points) else 0.0
        level = hangs - _BELOW * size
    scene.add_grid(
        '/floor', width=_FLOOR * size, height=_FLOOR * size, cell_size=size / _CELLS,
        section_size=size / _CELLS, cell_color=_GRID_COLOR, section_color=_GRID_COLOR,
        plane_color=_FLOOR_COLOR, plane_opacity=1.0, shadow_opacity=0.25,
        position=(float(middle[0]), float(middle[1]), level))


# The colliders in the scene of a page.

COLOR = (140, 148, 158)
# How far a plane is shown from its origin, in diagonals of the cloth.
_PLANE = 3.0


class ColliderDrawing:
    """A mesh for each collider, which moves with it."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Begin without colliders."""
        self._scene = server.scene
        self._handles: dict[str, viser.MeshHandle] = {}
        self._shown: tuple[Collider, ...] = ()

    def draw(self, frame: Frame) -> None:
        """Show the colliders of ``frame`` where they are, and planes around its cloth."""
        colliders = frame.colliders
        if colliders == self._shown:
            return
        self._shown = colliders
        names = {collider.name for collider in colliders}
        for name in self._handles.keys() - names:
            self._handles.pop(name).remove()
        for collider in colliders:
            if collider.name not in self._handles:
                self._handles[collider.name] = self._add(collider, diagonal(frame))
            handle = self._handles[collider.name]
            x, y, z, w = collider.orientation
            handle.position, handle.wxyz = np.array(collider.position), np.array((w, x, y, z))

    def _add(self, collider: Collider, size: float) -> viser.MeshHandle:
        points, _ = local_surface(collider.shape, collider.size, _PLANE * size)
        return self._scene.add_mesh_simple(
            f'/colliders/{collider.name}', points.reshape(-1, 3).astype(np.float32),
            triangles(*points.shape[:2]), color=COLOR)


# Handles by which pins are dragged.

# Max. number of handles [1]: more would hide the cloth; other pins are dots.
MOST_HANDLES = 16
# Size of a handle over the diagonal of the cloth [1].
_SIZE = 0.12

Node = tuple[int, int]


class PinHandles:
    """
    A set of arrows at each pin.

    :param answer: does an action for a page, and tells it what is wrong
    """

    def __init__(
            self, server: viser.ViserServer, source: Source,
            answer: Callable[[Any, Callable[[], Any]], None]) -> None:
        """Begin without pins."""
        self._scene = server.scene
        self._source = source
        self._answer = answer
        self._handles: dict[Node, viser.TransformControlsHandle] = {}
        # Those in somebody's hand: they lead their pins, and do not follow them. The lock keeps a
        # drag from beginning between the look at them and the change of a position.
        self._dragged: set[Node] = set()
        self._lock = Lock()
        # Moves wait for the simulation: one after the other, each to the newest place.
        self._moves = ThreadPoolExecutor(max_workers=1)
        self._targets: dict[Node, tuple[float, ...]] = {}

    def follow(self, frame: Frame, is_shown: bool) -> None:
        """Put a handle at each of the first pins, and none elsewhere."""
        pins = [(int(row), int(col)) for row, col in np.argwhere(frame.pinned)[:MOST_HANDLES]]
        wanted = set(pins) if is_shown else set()
        for node in self._handles.keys() - wanted:
            self._handles.pop(node).remove()
            self._dragged.discard(node)
        positions = frame.positions
        for node in pins if is_shown else ():
            if node not in self._handles:
                self._handles[node] = self._add(node, _SIZE * diagonal(frame))
            handle = self._handles[node]
            with self._lock:
                if node not in self._dragged and not np.array_equal(
                        handle.position, positions[node]):
                    handle.position = positions[node]

    def _add(self, node: Node, size: float) -> viser.TransformControlsHandle:
        handle = self._scene.add_transform_controls(
            f'/handles/{node[0]}_{node[1]}', scale=size, disable_rotations=True,
            depth_test=False)

        # Async, so that viser calls it in the order of the messages. Otherwise it runs later in a
        # thread, perhaps after the end of the drag, when ``follow`` has put the handle back.
        @handle.on_update
        async def _(event: viser.TransformControlsEvent) -> None:
            if event.phase == 'start':
                with self._lock:
                    self._dragged.add(node)
            elif event.phase == 'end':
                self._dragged.discard(node)
            else:
                self._targets[node] = tuple(float(part) for part in event.target.position)
                self._moves.submit(self._move, node, event.client)

        return handle

    def _move(self, node: Node, client: viser.ClientHandle | None) -> None:
        target = self._targets.pop(node, None)
        if target is not None:
            self._answer(client, lambda: self._source.move_pin(*node, target))
