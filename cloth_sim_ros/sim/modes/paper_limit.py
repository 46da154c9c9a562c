# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's adaptive scheme (Tab. 9): an edge beyond the limit is pulled to its rest length."""

import math

from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.loads import Loads
from cloth_sim_ros.sim.modes.mode import Pieces
from cloth_sim_ros.sim.modes.one_pass import OnePass
from cloth_sim_ros.sim.modes.paper_sweeps import PaperSweeps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.spring_tension import spring_tension
from cloth_sim_ros.sim.stability import stability_limit
from cloth_sim_ros.sim.state import State
import numpy as np

# Enough for the linear system of a small cloth; the error falls by some 10 % a sweep.
_SWEEPS = 60
# Of a substep: rounding that is no reason for another one.
_NOTHING = 1e-9


class PaperLimit:
    """
    Explicit springs within the limit, constraints to rest length beyond it.

    Kept for comparison: it fails at steps that other schemes take (docs/explanation/adaptive.md).

    :param length: of each substep [s]
    """

    substeps = 0  # of the last advance
    last_length = 0.0  # [s]

    def __init__(
            self, scene: Scene, layout: Layout, length: float) -> None:
        """Compile the passes."""
        self._scene = scene
        self._length = length
        self.strain_bound: float = scene['adaptive.threshold']
        self.stability_limit = stability_limit(scene)
        self.substep_margin = length / self.stability_limit
        self._springs = OnePass(scene, layout, 'RIGID_LIMIT')
        self._sweeps = PaperSweeps(scene, layout)

    def energy_law(self, state: State) -> EdgeLaw:
        """Return that of the springs: what holds an edge at its limit stores nothing."""
        return spring_law(self._scene, self._length)

    def advance(self, state: State, begin: float, seconds: float, loads: Loads) -> Pieces:
        """Step ``state`` on by ``seconds``."""
        self.substeps = math.ceil(seconds / self._length - _NOTHING)
        length = seconds / self.substeps
        for substep in range(self.substeps):
            start = begin + substep * length
            kick = 0.5 * ((self.last_length or length) + length)
            self._substep(state, loads.forcing(state, start, start + length, kick), length, kick)
            self.last_length = length
            yield

    def run_all_passes(self, state: State, loads: Loads) -> Pieces:
        """Make a substep of a ``state`` that nobody needs."""
        self._substep(state, loads.still, self._length, self._length)
        yield

    def resume(self, last_length: float) -> None:
        """Go on after springs alone, the last substep of which had ``last_length`` [s]."""
        self.last_length = last_length

    def clear_tally(self) -> None:
        """Count nothing: there are no solves."""

    def report(self) -> dict[str, float]:
        """Return nothing."""
        return {}

    def _substep(self, state: State, forcing: Forcing, length: float, kick: float) -> None:
        self._sweeps.clear()
        self._springs.run(state, forcing, length, kick)
        self._sweeps.run(state, _SWEEPS, length, kick)
        self._sweeps.finish(state, length)

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """Return what each edge was pulled back with in the last substep, or its spring's [N]."""
        springs = spring_tension(self._scene, positions, velocities, nodes)
        held = self._sweeps.read_tensions()
        return np.where(held == 0.0, springs, held)

    def forget(self) -> None:
        """Begin anew."""
        self.last_length = 0.0

    def delete(self) -> None:
        """Give passes and buffers back."""
        self._springs.delete()
        self._sweeps.delete()
