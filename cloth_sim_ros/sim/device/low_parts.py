# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What rounding takes from positions and velocities, for scenes whose substeps are too short."""

from functools import lru_cache

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Unit in the last place of float32 over the number, at most [1].
_ULP = 2.0**-23
# From rest, h v rounds to nothing until v = ulp / (2 h). By then ulp^2 / (8 g h^2) of the fall is
# lost, which is above one unit where g h^2 is below this share of it [1].
_LEAST_MOTION = 0.125
# That takes longer than dt, so that whole steps do not move, where g h dt is below this share of
# the unit [1]. Compensation takes 1.2 to 1.7 times as long on llvmpipe
# (benchmarks/short_steps.py), so that it is not made for short substeps of a long dt, which lose
# some micrometres of a fall at most.
_LEAST_STEP = 0.5
# Acceleration [m/s2], in scenes without gravity as well.
_GRAVITY = 9.81
# Size of those of a node [bytes]: three floats of its position and three of its velocity.
LOW_PART_BYTES = 24


def needs_low_parts(scene: Scene) -> bool:
    """Return whether sums of positions and velocities are compensated."""
    return largest_coordinate(scene) > plain_reach(scene)


@lru_cache(maxsize=16)
def plain_reach(scene: Scene) -> float:
    """
    Return the largest coordinate [m] that sums need not be compensated for.

    The substeps are those of the scene's mode; in mode constraint, where they follow the motion,
    the longest ones.
    """
    if scene['mode'] == 'constraint':
        substeps = 1 if scene['auto_substeps'] else scene['substeps']
    else:
        substeps = choose_substeps(scene) if scene['auto_substeps'] else scene['substeps']
    length = scene['dt'] / substeps
    return _GRAVITY * length / _ULP * max(length / _LEAST_MOTION, scene['dt'] / _LEAST_STEP)


def largest_coordinate(scene: Scene) -> float:
    """Return about the largest coordinate of the start [m]."""
    half_height = scene['height'] / 2.0
    is_hanging = scene['start.pose'] == 'hanging'
    return max(
        scene['width'] / 2.0, half_height, abs(scene['start.z']) + is_hanging * half_height)


class LowParts:
    """
    The low parts of all nodes, position and velocity, and those of the state that was kept.

    :param stored: nodes
    """

    def __init__(self, stored: int) -> None:
        """Allocate them; all are zero."""
        size = stored * LOW_PART_BYTES
        self._now, self._kept = Buffer(size), Buffer(size)
        for buffer in (self._now, self._kept):
            buffer.clear()

    def bind(self, binding: int, *, as_texture: bool) -> None:
        """Let the next dispatch change them; ``as_texture``: read them as texels as well."""
        self._now.bind_storage(binding)
        if as_texture:
            self._now.bind_texture(binding)

    def clear(self, first: int, count: int) -> None:
        """Make those of ``count`` stored nodes from ``first`` on zero."""
        self._now.write(
            np.zeros(count * LOW_PART_BYTES, dtype=np.uint8), first * LOW_PART_BYTES)

    def keep(self) -> None:
        """Keep them for ``restore``."""
        self._now.copy_to(self._kept, 0, self._now.bytes)

    def restore(self) -> None:
        """Go back to those that were kept."""
        self._kept.copy_to(self._now, 0, self._kept.bytes)

    def delete(self) -> None:
        """Free the memory."""
        self._now.delete()
        self._kept.delete()
