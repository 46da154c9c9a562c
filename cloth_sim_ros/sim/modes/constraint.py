# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Constraint enforcement: edges keep their length (paper, section 4.2)."""

from collections.abc import Collection
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.modes.implicit import ImplicitStep
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.state import State

# Strain up to which edges are held at once, over that under the weight of the cloth, s [1]: above
# 1, so that a cloth that hangs is not let go, and then s / 2 x 1.25^2 of weight x size is energy
# from nothing at most, 0.6 % by default; chosen: same bits from 0.625 to 2.5
# (benchmarks/constants.py --only _NOTABLE).
_NOTABLE = 1.25


class Constraint(ImplicitStep):
    """Hard edges, and springs where the scene asks for them."""

    name = 'constraint'
    is_implicit = True
    has_memory = True

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Compile the solver for the edges the scene asks for."""
        super().__init__(
            scene, layout, self.edge_families(scene),
            notable=_NOTABLE * scene['constraint.strain'])

    @staticmethod
    def edge_model(scene: Scene) -> str:
        """Return that edges are hard, or springs where none is to be."""
        return 'hard' if scene['constraint.hard'] else 'springs'

    @staticmethod
    def edge_families(scene: Scene) -> Collection[str]:
        """Return those that are hard, and those that are to be springs and have some."""
        springs = (family for family in scene.families if family in scene['constraint.springs'])
        return {*scene['constraint.hard'], *springs}

    def law(self, length: float, settling: float) -> EdgeLaw:
        """Return the law of hard edges, or that of springs with a limit that closes in on them."""
        hard, springs = self._scene['constraint.hard'], self._scene['constraint.springs']
        common = {
            'strain': self._scene['constraint.strain'], 'geometric': self._newton.beta}
        if settling:
            return edge_law(
                self._scene, length, springs={*hard, *springs}, limited=hard, limit=settling,
                **common)
        return edge_law(self._scene, length, hard=hard, springs=springs, **common)

    @property
    def strain_bound(self) -> float:
        """Return 0, or infinity where some structural or shear edges are springs."""
        are_all_hard = {'structural', 'shear'} <= set(self._scene['constraint.hard'])
        return 0.0 if are_all_hard else math.inf

    def limit_marks(self, state: State) -> Buffer | None:
        """Return None: an edge has no limit to come to, it is a constraint always."""
