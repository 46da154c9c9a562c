# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Conserve the momentum of a free cloth for any residual of the solver."""

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Invocations of a workgroup along a row and a column [1], as in Strips.
_LOCAL = (16, 2)
# Sums of rigid_sums.comp [1]: momenta and moments.
_SUMS = 15
# Moment of inertia over the largest one [1], below which the cloth is a line and can't be turned
# about it.
_FLAT = 1e-6


class FreeMotion:
    """
    Tensions change neither momentum nor angular momentum; a solve that stops early does a little.

    Both are carried on from substep to substep in double precision. As x+ = x + h v+, the angular
    momentum after a substep is that of v+ at the positions before it. So a rigid motion of the
    nodes, found there, makes up for the difference exactly.
    """

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate room for the sums; nothing is compiled yet."""
        # Mass of the cloth over that of a node inside [1].
        self._mass = float(scene.node_shares.sum())
        self._strips = Strips(layout, _SUMS)
        self._sums = SceneProgram('rigid_sums.comp', scene, layout, Strips.defines())
        self._add = SceneProgram(
            'rigid_add.comp', scene, layout, {'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1]})
        self._groups = -(-layout.cols // _LOCAL[0]), -(-layout.rows // _LOCAL[1])
        self.forget()

    def forget(self) -> None:
        """Adopt the momenta of the next state."""
        # Sums of numbers near zero keep more digits, so positions are taken from here.
        self._centre = np.zeros(3, dtype=np.float32)
        self._edits = -1
        self._momentum = np.zeros(3)
        self._spin = np.zeros(3)

    def aim_at(self, state: State, forcing: Forcing, still: Forcing, length: float) -> None:
        """Foresee the momenta that ``state`` must have after a substep of ``length`` [s]."""
        if state.edits != self._edits:
            self._edits = state.edits
            sums = self._sum(state, still, 0.0, 1.0, 0.0)
            self._momentum, self._spin = sums[:3], self._about_origin(sums)
        if forcing.has_regions or any(forcing.everywhere):
            sums = self._sum(state, forcing, length, 0.0, 0.0)
            self._momentum = self._momentum + sums[:3]
            self._spin = self._spin + self._about_origin(sums)

    def restore(self, state: State, still: Forcing, length: float) -> None:
        """Give ``state``, the substep made, those momenta."""
        sums = self._sum(state, still, 0.0, 1.0, length)
        offset = sums[3:6] / self._mass
        momentum = self._momentum - sums[:3]
        spin = self._spin - self._about_origin(sums) - np.cross(self._centre + offset, momentum)
        inertia = _inertia(sums[9:12], sums[12:15], offset, self._mass)
        if np.all(np.isfinite(sums)):
            turn = np.linalg.pinv(inertia, rcond=_FLAT, hermitian=True) @ spin
            self._run_add(state, length, momentum / self._mass, turn, offset)
            self._centre = (self._centre + offset).astype(np.float32)

    def delete(self) -> None:
        """Release passes and room."""
        self._strips.delete()
        self._sums.delete()
        self._add.delete()

    def _about_origin(self, sums: np.ndarray) -> np.ndarray:
        return sums[6:9] + np.cross(self._centre, sums[:3])

    def _sum(
            self, state: State, forcing: Forcing, length: float, share: float,
            back: float) -> np.ndarray:
        program = self._sums.use_for_step(forcing, length)
        program.set_float('share', share)
        program.set_float('back', back)
        program.set_vectors('centre', self._centre)
        state.bind_in()
        self._strips.dispatch(program)
        return self._strips.sums()

    def _run_add(
            self, state: State, length: float, push: np.ndarray, turn: np.ndarray,
            offset: np.ndarray) -> None:
        program = self._add.use()
        program.set_float('substep', length)
        program.set_vectors('centre', self._centre + offset)
        program.set_vectors('velocity', push)
        program.set_vectors('turn', turn)
        state.bind_in()
        state.bind_out()
        program.dispatch(*self._groups)
        shader_writes_visible()
        state.swap()


def _inertia(
        squares: np.ndarray, products: np.ndarray, offset: np.ndarray, mass: float) -> np.ndarray:
    """Return the moments of inertia of nodes of ``mass`` in all about their centre."""
    moments = np.diag(squares)
    moments[[0, 0, 1], [1, 2, 2]] = products
    moments[[1, 2, 2], [0, 0, 1]] = products
    about_centre = moments - mass * np.outer(offset, offset)
    return np.trace(about_centre) * np.eye(3) - about_centre
