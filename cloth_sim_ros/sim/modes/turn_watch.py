# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long a substep with edges of frozen direction may be."""

import math

from cloth_sim_ros.sim.edge_kinds import edge_defines
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.strips import Strips

# Of the length, lost by an edge that turns in one substep: (omega h)^2 / 2.
_TURN = 0.0025


class TurnWatch:
    """
    Measures how fast edges turn and how far they stretch (docs/explanation/implicit_step.md).

    :param families: of the edges that are looked at
    """

    def __init__(self, scene: Scene, layout: Layout, families: tuple[str, ...]) -> None:
        """Allocate room for the result; nothing is compiled yet."""
        self._strips = Strips(layout, 2)
        self._program = SceneProgram('turn_watch.comp', scene, layout, {
            **Strips.defines(),
            **edge_defines(families)})

    def look(self, state: State, forcing: Forcing, dt: float) -> tuple[float, float]:
        """
        Return the longest substep [s] in which no edge turns too far, and the largest strain.

        The strain is abs(l / L0 - 1), of structural and shear edges.

        :param forcing: that acts for ``dt`` [s] from now
        """
        program = self._program.use_for_step(forcing, dt)
        state.bind_in()
        self._strips.dispatch(program)
        turns, strain = (float(largest) for largest in self._strips.largest())
        return math.sqrt(2.0 * _TURN / turns) if turns > 0.0 else math.inf, strain

    def delete(self) -> None:
        """Give pass and room back."""
        self._strips.delete()
        self._program.delete()
