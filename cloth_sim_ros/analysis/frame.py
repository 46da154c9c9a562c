# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The cloth at one moment of a recording."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from functools import lru_cache
from typing import Any
from typing import Literal

from cloth_sim_ros.messages.geometry import push_arrows
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.mesh import Mesh
from cloth_sim_ros.sim.mesh import mesh_of_nodes
from cloth_sim_ros.sim.model.cells import present_nodes
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.snapshot import present_cells
import numpy as np

_KINDS = {
    1: np.int8, 2: np.uint8, 3: np.int16, 4: np.uint16, 5: np.int32, 6: np.uint32,
    7: np.float32, 8: np.float64,
}
_NEEDED = ('x', 'y', 'z', 'normal_x', 'normal_y', 'normal_z', 'strain', 'flags')


@dataclass(frozen=True)
class Frame:
    """
    All nodes at one time.

    :param time: [s] simulated, going on where a reset put the clock back
    :param records: (rows, cols), the fields of ~/points
    :param pushes: those known so far, with ``start`` in the same time
    :param colliders: where they are at this time; none where that is not known
    """

    time: float
    records: np.ndarray
    pushes: Sequence[Push] = ()
    colliders: tuple[Collider, ...] = ()

    @classmethod
    def from_points(
            cls, time: float, cloud: Any, pushes: Sequence[Push] = (),
            colliders: tuple[Collider, ...] = ()) -> 'Frame':
        """Return the frame of a decoded PointCloud2; ClothSimError when it is no cloth."""
        names = {field.name for field in cloud.fields}
        missing = [name for name in _NEEDED if name not in names]
        if missing:
            raise ClothSimError(
                f'the cloud at {time:g} s has no field {missing[0]}: '
                'give a recording of a cloth_sim node')
        try:
            layout = _layout(
                tuple((field.name, field.datatype, field.offset) for field in cloud.fields),
                cloud.point_step, bool(cloud.is_bigendian))
            records = np.frombuffer(cloud.data, layout).reshape(cloud.height, cloud.width)
        except (KeyError, ValueError, TypeError) as error:
            raise ClothSimError(
                f'the cloud at {time:g} s does not have its declared length, or has unknown '
                f'fields ({error}): give a recording of a cloth_sim node') from error
        if records['flags'].dtype.kind not in 'iu':
            raise ClothSimError(
                f'the cloud at {time:g} s has flags of the type {records["flags"].dtype}, which '
                'must be whole numbers: give a recording of a cloth_sim node')
        if not records.size:
            raise ClothSimError(
                f'the cloud at {time:g} s has no points: give a recording of a cloth_sim node')
        return cls(time, records, tuple(pushes), colliders)

    @property
    def positions(self) -> np.ndarray:
        """Get the positions [m], (rows, cols, 3) float64."""
        return self._vectors('x', 'y', 'z')

    @property
    def normals(self) -> np.ndarray:
        """Get the unit normals, (rows, cols, 3) float64."""
        return self._vectors('normal_x', 'normal_y', 'normal_z')

    @property
    def strain(self) -> np.ndarray:
        """Get the largest abs(l / L0 - 1) at each node, (rows, cols)."""
        return self.records['strain']

    @property
    def pinned(self) -> np.ndarray:
        """Return which nodes are held, (rows, cols) bool."""
        return (self.records['flags'] & FLAG_PINNED) != 0

    @property
    def grasped(self) -> np.ndarray:
        """Return which of them grasps hold, (rows, cols) bool."""
        return (self.records['flags'] & FLAG_GRASPED) != 0

    @cached_property
    def cells(self) -> np.ndarray:
        """Return which cells exist, (rows - 1, cols - 1) bool."""
        return present_cells(self.records['flags'])

    @cached_property
    def present(self) -> np.ndarray:
        """Return which nodes exist, (rows, cols) bool: all, or those of a shape."""
        if self.cells.all():
            return np.ones(self.records.shape, dtype=bool)
        return present_nodes(self.cells)

    @property
    def acting_pushes(self) -> tuple[Push, ...]:
        """Get the pushes that act at this time."""
        return tuple(push for push in self.pushes if push.start <= self.time < push.end)

    def push_arrows(self, length: float) -> list[np.ndarray]:
        """Return tail and tip [m] of each acting push; the largest is ``length`` long."""
        pushes = self.acting_pushes
        return push_arrows(pushes, self.time, self.positions.reshape(-1, 3), length)

    def mesh(self) -> Mesh:
        """Return the surface as triangles, without what a shape cuts away."""
        return mesh_of_nodes(self.positions, self.normals, self.cells)

    def _vectors(self, *names: str) -> np.ndarray:
        return np.stack([self.records[name] for name in names], axis=-1).astype(float)


@lru_cache(maxsize=16)
def _layout(fields: tuple[tuple[str, int, int], ...], size: int, big_endian: bool) -> np.dtype:
    """Return the type of a point; all clouds of a recording have one."""
    names, kinds, offsets = zip(*fields)
    order: Literal['<', '>'] = '>' if big_endian else '<'
    layout: Any = {
        'names': names, 'formats': [np.dtype(_KINDS[kind]).newbyteorder(order) for kind in kinds],
        'offsets': offsets, 'itemsize': size}
    return np.dtype(layout)
