# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Passes in which an invocation looks at a strip of a column and leaves its figures behind."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.layout import Layout
import numpy as np

_LOCAL = (16, 2)
_STRIP = 16


class Strips:
    """
    The invocations of such a pass, and the figures they leave.

    :param figures: how many floats each invocation leaves
    """

    def __init__(self, layout: Layout, figures: int) -> None:
        """Allocate room for the figures."""
        strips = -(-layout.rows // _STRIP)
        self._groups = -(-layout.cols // _LOCAL[0]), -(-strips // _LOCAL[1])
        self._figures = np.empty((strips * layout.cols, figures), dtype=np.float32)
        self._buffer = Buffer(self._figures.nbytes)

    @staticmethod
    def defines() -> dict[str, object]:
        """Return what the shader of such a pass needs to know."""
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
        """Give the room back."""
        self._buffer.delete()
