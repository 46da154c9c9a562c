# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The programs of a scene: compiled with only what it uses, and passes over its strips."""

from collections.abc import Mapping

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.model.colliders import collider_defines
from cloth_sim_ros.sim.model.edge_kinds import edge_defines
from cloth_sim_ros.sim.model.edge_kinds import REST_KINDS
from cloth_sim_ros.sim.model.edge_kinds import rest_lengths
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import MOST_MAGNITUDE
import numpy as np

# Invocations of a workgroup of Strips along a row and a column [1].
_LOCAL = (16, 2)
# Nodes of a column that one invocation of Strips looks at [1].
_STRIP = 16


class SceneProgram:
    """
    A shader of a scene, compiled when it is first used.

    :param name: file in shaders/
    :param layout: of the lattice it runs on
    :param defines: choices of this shader besides those of scene and layout
    """

    def __init__(
            self, name: str, scene: Scene, layout: Layout,
            defines: Mapping[str, object] | None = None) -> None:
        """Remember what to compile."""
        self._name = name
        self._scene = scene
        self._layout = layout
        self._defines = {**layout.defines(), **scene_defines(scene), **(defines or {})}
        self._program: Program | None = None
        self._set: tuple[Forcing, float, float | None] | None = None

    def use_for_step(
            self, forcing: Forcing, length: float, kick: float | None = None) -> Program:
        """
        Return the program, in use and set to a substep of ``length`` [s] under ``forcing``.

        :param kick: what forces act for [s], in shaders that distinguish it from the length
        """
        program = self.use()
        forcing.bind()
        # Most steps are like the one before, and a uniform costs as much as a small dispatch.
        if self._set != (forcing, length, kick):
            program.set_float('substep', length)
            if kick is not None:
                program.set_float('kick', kick)
            forcing.apply(program)
            self._set = (forcing, length, kick)
        return program

    def use(self) -> Program:
        """Return the program, in use."""
        if self._program is None:
            self._program = Program(ShaderSource(self._name, self._defines))
            self._program.use()
            self._layout.set_in(self._program)
            _set_springs(self._program, self._scene)
        self._program.use()
        return self._program

    def delete(self) -> None:
        """Release the program; it is compiled again at the next use."""
        if self._program is not None:
            self._program.delete()
            self._program = self._set = None


def scene_defines(scene: Scene) -> dict[str, object]:
    """Return what the scene's shaders compile in."""
    has_damping = any(scene.damping(family) > 0.0 for family in FAMILIES)
    return {
        'MOST_MAGNITUDE': f'{MOST_MAGNITUDE:e}',
        'HAS_CELLS': int(scene.cells is not None),
        'HAS_HELD': 0,
        'HAS_DAMPING': int(has_damping),
        'HAS_RIGIDITY': int(scene.has_rigidity),
        'HAS_BENDING_DAMPING': int(scene.has_bending_damping),
        'HAS_CONTACT': int(scene.has_contact),
        'HAS_SURFACE': 0,
        'HAS_SELF': int(scene['self_contact.enabled']),
        'HAS_LOW_PARTS': int(needs_low_parts(scene)),
        **(collider_defines(scene.colliders) if scene.has_contact else {}),
        **edge_defines(scene.families),
    }


def _set_springs(program: Program, scene: Scene) -> None:
    program.set_floats('stiffness', [kind.stiffness(scene) for kind in REST_KINDS])
    program.set_floats('damping', [kind.damping(scene) for kind in REST_KINDS])
    program.set_floats('rest_length', rest_lengths(scene))
    program.set_floats('bending', scene.bending)
    program.set_float('bending_damping', scene['bending.damping'])
    program.set_float('inverse_mass', 1.0 / scene.node_mass)
    program.set_float('limit', scene['adaptive.threshold'])
    program.set_vectors('gravity', scene['gravity'])


# Passes in which an invocation looks at a strip of a column and leaves its figures behind.

class Strips:
    """
    The invocations of such a pass, and the figures they leave.

    :param figures: how many floats each invocation leaves
    """

    def __init__(self, layout: Layout, figures: int) -> None:
        """Allocate room for the figures."""
        strips = -(-layout.rows // _STRIP)
        self._groups = self.groups(layout)
        self._figures = np.empty((strips * layout.cols, figures), dtype=np.float32)
        self._buffer = Buffer(self._figures.nbytes, is_polled=True)

    @staticmethod
    def groups(layout: Layout) -> tuple[int, int]:
        """Return the workgroups of such a pass along a row and down the columns."""
        return -(-layout.cols // _LOCAL[0]), -(-layout.rows // (_STRIP * _LOCAL[1]))

    @staticmethod
    def defines() -> dict[str, object]:
        """Return the defines of the shader of such a pass."""
        return {'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1], 'STRIP': _STRIP}

    def dispatch(self, program: Program) -> None:
        """Run ``program``, which is in use and has its other buffers bound."""
        self._buffer.bind_storage(bindings.PARTIAL_SUMS)
        program.dispatch(*self._groups)
        shader_writes_visible()

    def largest(self) -> np.ndarray:
        """Wait for the pass, and return the largest of each figure; NaN where one is NaN."""
        return self.read().max(axis=0)

    def read(self) -> np.ndarray:
        """Wait for the pass, and return what each invocation left, (invocations, figures)."""
        self._buffer.read_into(self._figures)
        return self._figures

    def sums(self) -> np.ndarray:
        """Wait for the pass, and return the sum of each figure, float64."""
        return self.read().sum(axis=0, dtype=np.float64)

    def delete(self) -> None:
        """Release the room."""
        self._buffer.delete()
