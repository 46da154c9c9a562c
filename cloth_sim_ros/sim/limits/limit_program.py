# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A pass of shaders/limit/, and how exactly it holds edges."""

from collections.abc import Mapping
from dataclasses import dataclass

from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.limits.limit_law import limit_law
from cloth_sim_ros.sim.loads.forcing import Touch
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Strain over the limit from which on an edge is solved for [1]; an edge that is not passes its
# limit if the impulses of others throw it that far in a substep.
NEAR = 0.9
# Strain over the limit, now or as many substeps ahead as a block has nodes along a side, from
# which on the edges of a block and of those around it are looked at in each of these substeps [1].
_WIDE = 0.5
# Change of a length by a round below which no further one is made [1], over the distance that a
# node falls in a substep: the force at the pin of 15 hanging edges then trembles by 1e-4 of the
# weight, and at 1e-3 by 1e-3 (force_tremor.py).
_TOLERANCE = 1e-5
# Changes of a length that suffice, too, so that each substep continues the rounds of the one
# before: over the first change of the substep [1], at rest and in motion, but no more than a
# fraction of the limit of the shortest edge [1]; and the first change from which on a cloth counts
# as moving, over the distance that a node falls in a substep [1].
_REDUCTION = (0.1, 0.5)
_LOOSE = 0.01
_MOTION = 0.01
# Fraction of what an edge is beyond its limit that a substep takes away [1].
CLOSING = 0.1
# Max. rounds of a substep [1].
MOST_ROUNDS = 400
# Max. factor of the impulses of the previous substep [1].
MOST_SCALE = 1.5
# Gravity where the scene has none [m/s2].
_STANDARD_GRAVITY = 9.81


@dataclass(frozen=True)
class Limits:
    """
    The limits in a substep.

    :param length: of the substep [s]
    :param strain: of the limit
    :param is_rough: whether nodes move so far in it that impulses throw edges past their limit
        that were not listed
    """

    length: float
    strain: float
    is_rough: bool = False


class LimitProgram:
    """
    A pass, compiled when it is first used.

    :param name: of the shader
    """

    def __init__(
            self, name: str, scene: Scene, layout: Layout,
            defines: Mapping[str, object] | None = None) -> None:
        """Remember what to compile."""
        self._pass = SceneProgram(name, scene, layout, defines)
        self._layout = layout
        self._set: Limits | None = None
        self._adds: bool | None = None
        gravity = float(np.linalg.norm(scene['gravity'])) or _STANDARD_GRAVITY
        law = limit_law(scene, scene['adaptive.threshold'])
        self._stiffness = [law.limit_stiffness[rest] for rest in range(3)]
        self._gravity = gravity
        self._rest = min(scene.spacing)

    def sufficient(self, limits: Limits, first: float) -> float:
        """Return the change of a length [m] that suffices, as limit_tolerance.glsl does."""
        tolerance, loose, motion = self._tolerances(limits)
        share = _REDUCTION[first > motion]
        return max(tolerance, min(loose, share * first))

    def use(
            self, limits: Limits, touch: Touch | None = None, *, adds: bool = False) -> Program:
        """
        Return the program, in use and set to a substep.

        :param adds: whether it lists edges beside those listed in the substep
        """
        program = self._pass.use()
        if limits is not self._set and limits != self._set:
            program.set_float('substep', limits.length)
            program.set_float('limit', limits.strain)
            program.set_int('block_count', self._layout.block_count)
            program.set_float('ahead', self._layout.block * limits.length)
            program.set_float('wide', 0.0 if limits.is_rough else _WIDE)
            program.set_float('closing', CLOSING)
            program.set_floats('compliance', self._compliances(limits.length))
            tolerance, loose, motion = self._tolerances(limits)
            program.set_float('tolerance', tolerance)
            program.set_float('loose_tolerance', loose)
            program.set_float('motion', motion)
            program.set_pair('reduction', _REDUCTION)
            program.set_float('most_scale', MOST_SCALE)
            program.set_int('round_limit', MOST_ROUNDS)
            self._set = limits
        if adds is not self._adds:
            program.set_float('near', 1.0 if adds else NEAR)
            program.set_int('adds', int(adds))
            self._adds = adds
        if touch is not None:
            touch.set_in(program, limits.length)
        return program

    @property
    def made(self) -> Program:
        """Return the program, bound, with its uniforms set."""
        return self._pass.use()

    def _compliances(self, length: float) -> list[float]:
        """Return what edges pass their limit by for each impulse, where they stay there [s]."""
        # The excess is removed, a fraction per substep.
        return [CLOSING / (length * stiffness) for stiffness in self._stiffness]

    def _tolerances(self, limits: Limits) -> tuple[float, float, float]:
        fall = self._gravity * limits.length**2
        return _TOLERANCE * fall, _LOOSE * limits.strain * self._rest, _MOTION * fall

    def delete(self) -> None:
        """Release the program."""
        self._pass.delete()
        self._set = self._adds = None
