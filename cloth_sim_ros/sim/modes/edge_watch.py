# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Watch for edges near their limit, and for edges that turn too far in a substep."""

import math

from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.edge_kinds import edge_defines
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Max. relative change of an edge's length by its rotation in one substep, (omega h)^2 / 2 [1]: the
# mean over all edges, weighted with the energy that each loses by it, and the largest. They decide
# about accuracy as dt does; docs/explanation/implicit_step.md.
_MEAN_TURN = 0.002
_LARGEST_TURN = 0.0075
# Substeps that a look ahead covers at first, and at most [1].
_FEWEST = 4
_MOST = 64


def _bind(state: State, forcing: Forcing, ahead: float) -> None:
    """Let a pass read ``state`` with the velocities that are expected ``ahead`` [s]."""
    if forcing.touch is None:
        state.bind_in()
    else:
        forcing.touch.foresee(state, forcing, ahead)
        state.bind_expected()


class StrainWatch:
    """
    Predicts for how many substeps no edge comes near its limit.

    A look predicts every edge's length from velocities and applied accelerations. It holds for as
    long as no edge comes near by that, also beyond the end of a step, while neither the state is
    changed from outside nor a push acts. The next look is up to twice as far.

    :param near: strain of an edge that is near its limit
    """

    def __init__(self, scene: Scene, layout: Layout, near: float) -> None:
        """Compile the pass and allocate its result."""
        self._strips = Strips(layout, 2)
        self._program = SceneProgram('strain_watch.comp', scene, layout, Strips.defines())
        self._program.use()
        self._near = near
        self.forget()

    def forget(self) -> None:
        """Drop the prediction: the next answer needs a new one."""
        self._reach = _FEWEST
        self._left = 0
        self._until = 0.0
        self._edits = -1

    def calm_substeps(
            self, state: State, now: float, length: float, loads: Loads) -> int:
        """Return how many substeps of ``length`` [s] can do without limits; 0 if none."""
        if self._left == 0 or not self._holds(state, now, loads):
            self._look_ahead(state, now, length, loads)
        return self._left

    def advance(self, substeps: int) -> None:
        """Count ``substeps`` of the calm ones as made."""
        self._left -= substeps

    def strains(self, state: State, forcing: Forcing, ahead: float) -> tuple[float, float]:
        """Return the largest strain now and the one predicted ``ahead`` [s] from now."""
        _bind(state, forcing, ahead)
        program = self._program.use_for_step(forcing, ahead)
        self._strips.dispatch(program)
        now, then = self._strips.largest()
        return float(now), float(then)

    def delete(self) -> None:
        """Release pass and result."""
        self._strips.delete()
        self._program.delete()

    def _holds(self, state: State, now: float, loads: Loads) -> bool:
        return state.edits == self._edits and loads.quiet_until(now) >= self._until

    def _look_ahead(
            self, state: State, now: float, length: float, loads: Loads) -> None:
        # A push takes the nodes of the time it begins, so no look goes beyond that; and while one
        # acts each look is for the next substep alone.
        quiet = int(min(self._reach, (loads.quiet_until(now) - now) / length))
        reach = max(1, quiet)
        forcing = loads.foreseen(state, now, now + length, is_quiet=quiet > 0)
        self._until = now + reach * length
        self._edits = state.edits
        present, ahead = self.strains(state, forcing, reach * length)
        self._left = reach
        if not max(present, ahead) < self._near:
            # An edge's length is a convex function of time: until then it is below the chord.
            share = (self._near - present) / (ahead - present) if present < self._near else 0.0
            self._left = int(share * reach) if math.isfinite(share) else 0
            self._until = now + self._left * length
        self._reach = min(max(2 * self._left, _FEWEST), _MOST)


class TurnWatch:
    """
    Measures how fast edges turn and how far they stretch (docs/explanation/implicit_step.md).

    :param families: of the edges that are looked at
    """

    def __init__(self, scene: Scene, layout: Layout, families: tuple[str, ...]) -> None:
        """Allocate room for the result; nothing is compiled yet."""
        self._strips = Strips(layout, 4)
        self._program = SceneProgram('turn_watch.comp', scene, layout, {
            **Strips.defines(),
            **edge_defines(families)})

    def look(self, state: State, forcing: Forcing, dt: float) -> tuple[float, float]:
        """
        Return the longest substep [s] in which edges do not turn too far, and the largest strain.

        The strain is abs(l / L0 - 1), of structural and shear edges.

        :param forcing: that acts for ``dt`` [s] from now
        """
        _bind(state, forcing, dt)
        program = self._program.use_for_step(forcing, dt)
        self._strips.dispatch(program)
        turns, strains, weights, means = self._strips.read().astype(float).T
        turn = turns.max() / _LARGEST_TURN
        if weights.any():
            turn = np.fmax(turn, np.average(means, weights=weights) / _MEAN_TURN)
        longest = math.sqrt(2.0 / turn) if turn > 0.0 else math.inf
        return longest, float(strains.max())

    def delete(self) -> None:
        """Release pass and room."""
        self._strips.delete()
        self._program.delete()
