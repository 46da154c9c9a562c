# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The lattices of the solver, from the cloth down to a few nodes, and where each is stored."""

import math

from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.layout import Layout
import numpy as np

# A coarsest level of up to this many nodes a side is solved in one workgroup.
COARSEST_SIDE = 8
# As in solver/levels.glsl: enough for any cloth that buffers can hold.
MOST_LEVELS = 16
_CLOTH_VECTORS = 8
# With bend edges, and with damped bending, two fields more for each.
_CLOTH_SYSTEM, _MORE_SYSTEM = 7, 2
_CONTACT_VECTORS, _CONTACT_SYSTEM = 5, 2
_COARSE_VECTORS = 3
_COARSE_SYSTEM = 10
# Nodes along each side of an invocation, an even number, and invocations of a workgroup.
# Software runs whole workgroups even where a level ends, so small ones leave less idle.
_ON_SOFTWARE = (4, (8, 2))
# What a tile has to hold for damped bending, or for rigidity beside bend edges: with 4 x 4 nodes
# a program of it takes llvmpipe minutes to compile.
_ON_SOFTWARE_WITH_MUCH = (2, (8, 2))
_ON_GPU = (2, (8, 8))
_BYTES = 16


class Levels:
    """
    The cloth and, if asked for, ever coarser levels.

    :param state: how the state is stored, which tells what suits the device
    :param coarsen: False keeps to the cloth alone
    :param has_bend: whether there are bend edges in the system
    :param has_rigidity: whether there is rigidity in it
    :param has_bending_damping: whether there is damped bending in it
    :param has_contact: whether nodes can touch something
    """

    def __init__(
            self, state: Layout, *, coarsen: bool, has_bend: bool,
            has_rigidity: bool = False, has_bending_damping: bool = False,
            has_contact: bool = False) -> None:
        """Lay out all levels."""
        has_much = has_bending_damping or (has_bend and has_rigidity)
        self.layouts = [_layout(state, state.rows, state.cols, has_much)]
        while coarsen and (len(self.layouts) == 1 or self._coarsest_side > COARSEST_SIDE):
            finer = self.layouts[-1]
            self.layouts.append(
                _layout(state, -(-finer.rows // 2), -(-finer.cols // 2), has_much))
        coarse = len(self.layouts) - 1
        vectors = [_CLOTH_VECTORS + _CONTACT_VECTORS * has_contact] + [_COARSE_VECTORS] * coarse
        of_cloth = (
            _CLOTH_SYSTEM + _MORE_SYSTEM * (has_bend + has_bending_damping)
            + _CONTACT_SYSTEM * has_contact)
        system = [of_cloth] + [_COARSE_SYSTEM] * coarse
        stored = np.array([layout.stored for layout in self.layouts])
        ends = np.cumsum([stored * vectors, stored * system], axis=1)
        self._begins = (ends - [stored * vectors, stored * system]).T
        self.vector_bytes, self.system_bytes = (int(end) * _BYTES for end in ends[:, -1])

    @property
    def cloth(self) -> Layout:
        """Return the finest level."""
        return self.layouts[0]

    @property
    def coarsest(self) -> int:
        """Return the number of the last level."""
        return len(self.layouts) - 1

    def set_in(self, program: Program) -> None:
        """Set the uniforms of the lattices of all levels in the program in use."""
        self.cloth.set_in(program)
        program.set_int_vectors('level_shape', np.array([
            (layout.rows, layout.cols, layout.pitch, layout.stored) for layout in self.layouts]))
        program.set_int_vectors('level_begin', self._begins)

    @property
    def _coarsest_side(self) -> int:
        return max(self.layouts[-1].rows, self.layouts[-1].cols)


class _InLine(Layout):
    """Counts blocks row by row, see solver/block_of_invocation.glsl."""

    @property
    def groups(self) -> tuple[int, int]:
        across, down = (-(-nodes // self.block) for nodes in (self.cols, self.rows))
        return -(-across * down // math.prod(self.local)), 1


def _layout(state: Layout, rows: int, cols: int, has_much: bool) -> Layout:
    if state.texture_loads:
        return _InLine(
            rows, cols, 'fused', True, *(_ON_SOFTWARE_WITH_MUCH if has_much else _ON_SOFTWARE))
    return Layout(rows, cols, 'fused', False, *_ON_GPU)
