# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a grasp is to hold, and which nodes that are."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.model.body_names import NAME_PATTERN
from cloth_sim_ros.sim.model.pose import checked_position
from cloth_sim_ros.sim.model.pose import NO_ROTATION
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.model.scene_fields import ALL_LAYERS
from cloth_sim_ros.sim.model.scene_fields import LAYERS
from cloth_sim_ros.sim.model.scene_fields import TOP_LAYER
from cloth_sim_ros.sim.model.top_layer import top_layer
import numpy as np

# Max. number of a request, over the unit of its field [1].
_LARGEST = 1e9


@dataclass(frozen=True)
class GraspRequest:
    """
    What is to be held.

    :param name: of the grasp, of its own among those that hold something
    :param pose: of its frame
    :param radius: the free nodes within it are held [m]; 0 for the nearest ones
    :param count: how many of these
    :param layers: ALL_LAYERS within reach, or TOP_LAYER for the highest of them
    :param max_force: pull of the cloth at which it is lost [N]; 0 for never
    :param start: simulated time at which it begins [s]
    :param release: at which it ends; 0 for not by itself
    """

    name: str
    pose: Pose
    radius: float = 0.0
    count: int = 1
    layers: str = ALL_LAYERS
    max_force: float = 0.0
    start: float = 0.0
    release: float = 0.0

    @classmethod
    def checked(
            cls, *, name: str, position: Sequence[float],
            orientation: Sequence[float] | None = None, radius: float = 0.0, count: int = 0,
            layers: str = ALL_LAYERS, max_force: float = 0.0, start: float = 0.0,
            release: float = 0.0) -> 'GraspRequest':
        """Return a GraspRequest, or raise ClothSimError saying which value is wrong."""
        if not isinstance(name, str) or not NAME_PATTERN.fullmatch(name):
            raise ClothSimError(
                f'{shown(name)} is no name of a grasp: give lower-case letters, digits and '
                'underscores, beginning with a letter, 40 at most')
        radius = real_number(radius, f'the radius of grasp {name}', 'give it in metres')
        max_force = real_number(max_force, f'the max_force of grasp {name}', 'give it in newtons')
        count = integer(count, f'the count of grasp {name}', 'give a number of nodes')
        for quantity, value in (('radius', radius), ('max_force', max_force)):
            if not 0.0 <= value <= _LARGEST:
                raise ClothSimError(
                    f'the {quantity} of grasp {name} must be from 0 to {_LARGEST:g}, got {value}: '
                    'give 0 for none')
        if count < 0:
            raise ClothSimError(
                f'the count of grasp {name} must be 0 or more, got {shown(count)}: give 0 for 1 '
                'node')
        if radius > 0.0 and count > 0:
            raise ClothSimError(
                f'grasp {name} has a radius and a count, {radius:g} m and {count}: give one of '
                'them')
        if not isinstance(layers, str) or layers not in LAYERS:
            raise ClothSimError(
                f'the layers of grasp {name} must be one of {", ".join(LAYERS)}, got '
                f'{shown(layers)}: give {TOP_LAYER} for the highest layer alone')
        if release and release <= start:
            raise ClothSimError(
                f'grasp {name} is released at {release:g} s and begins at {start:g} s: release '
                'it later, or give 0 for never')
        return cls(
            name, Pose(
                checked_position(position, f'the position of grasp {name}'),
                NO_ROTATION if orientation is None
                else unit_quaternion(orientation, f'the orientation of grasp {name}')),
            radius, max(count, 1), layers, max_force, float(start), float(release))

    def chosen(
            self, positions: np.ndarray, pinned: np.ndarray, reach: float,
            present: np.ndarray | None = None) -> np.ndarray:
        """
        Return rows and columns of the nodes that it takes, (n, 2).

        :param positions: (rows, cols, 3) [m]
        :param pinned: which nodes are held by something else, (rows, cols) bool
        :param reach: how far the nearest node may be where there is no radius [m]
        :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
        :raises ClothSimError: when there is none
        """
        distance = np.linalg.norm(positions.astype(float) - np.array(self.pose.position), axis=-1)
        within = self.radius or reach
        if self.layers == TOP_LAYER:
            distance[~top_layer(positions, self.pose.position, within, present)] = math.inf
        # There is no node where positions are NaN.
        distance[pinned | np.isnan(distance)] = math.inf
        if self.radius > 0.0:
            nodes = np.argwhere(distance <= self.radius)
        else:
            nearest = np.argsort(distance, axis=None, kind='stable')[:self.count]
            nodes = np.argwhere(np.isin(
                np.arange(distance.size).reshape(distance.shape), nearest)
                & (distance <= reach))
        if len(nodes):
            return nodes
        x, y, z = self.pose.position
        where = f'grasp {self.name} at ({x:g}, {y:g}, {z:g}) has no free node'
        if self.layers == TOP_LAYER:
            raise NotFoundError(
                f'{where} of the top layer within {within:.3g} m: give a point nearer to that '
                f'layer, a larger radius, or layers {ALL_LAYERS}')
        raise NotFoundError(
            f'{where} within {within:.3g} m: the nearest is {float(distance.min()):.3g} m away; '
            'give a point nearer to the cloth, or a larger radius')
