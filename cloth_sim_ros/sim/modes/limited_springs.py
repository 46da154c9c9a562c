# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Springs with a strain limit, by the edge law of docs/explanation/implicit_step.md."""

from collections.abc import Collection

from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.implicit import ImplicitStep
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import BETA
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw

# Bend springs may bend as far as they like: it is not a strain of the cloth.
LIMITED = ('structural', 'shear')
# What an edge that carries the weight of the cloth is beyond its limit: a share of the limit, and
# no more than a strain at which a push of many times the weight is held as well.
_SHARE = 0.1
_MOST = 0.003


class LimitedSprings(ImplicitStep):
    """
    Springs of ``families`` with the scene's ``adaptive.threshold``.

    A cloth that comes from beyond its limit is held to the strain it has, which closes in.
    """

    def __init__(self, scene: Scene, layout: Layout, families: Collection[str]) -> None:
        """Compile the solver."""
        self._families = families
        super().__init__(scene, layout, families)

    @property
    def strain_bound(self) -> float:
        """Return the strain limit that holds now."""
        return max(self.settling.limit, self._scene['adaptive.threshold'])

    def law(self, length: float, settling: float) -> EdgeLaw:
        """Return the law of springs with their limit, or what is left of the strain they had."""
        return edge_law(
            self._scene, length, springs=self._families, limited=LIMITED,
            limit=max(settling, self._scene['adaptive.threshold']),
            strain=min(_SHARE * self._scene['adaptive.threshold'], _MOST),
            geometric=BETA if self._solves > 1 else 0.0)
