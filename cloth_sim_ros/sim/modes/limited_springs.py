# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Springs within a strain limit, the whole cloth in one implicit step."""

from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.limits.limit_law import limit_law
from cloth_sim_ros.sim.limits.limit_law import strain_past_limit
from cloth_sim_ros.sim.modes.implicit import ImplicitStep
from cloth_sim_ros.sim.modes.implicit import Newton
from cloth_sim_ros.sim.modes.implicit import Settling
from cloth_sim_ros.sim.modes.paper.one_solve import ONE_SOLVE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw

# Strain over which a limit comes into force, over that past it [1]; chosen: solves change by +20 %
# at 0 (a kink) and by -7 % at 2 (constants.py --only _TRANSITION).
_TRANSITION = 1.0


def transition_of(scene: Scene) -> float:
    """Return half the strain over which a limit comes into force."""
    return _TRANSITION * strain_past_limit(scene)


class LimitedSprings(ImplicitStep):
    """
    The springs of the scene with its ``adaptive.threshold``.

    A limit begins to pull at that strain: an edge that was held exactly there has no energy of its
    limit, so that explicit and implicit substeps can alternate.

    :param settling: the limit of a cloth that comes with more strain
    """

    def __init__(
            self, scene: Scene, layout: Layout, settling: Settling) -> None:
        """Compile the solver."""
        super().__init__(scene, layout, scene.families, notable=0.0)
        self.settling = settling

    @staticmethod
    def newton(scene: Scene) -> Newton:
        """Return how Newton's method is applied."""
        has_one = scene['constraint.newton_iterations'] == 1
        return ONE_SOLVE if has_one else ImplicitStep.newton(scene)

    @property
    def is_settling(self) -> bool:
        """Return whether the limit that holds now is a wider one."""
        return self.settling.limit > self._scene['adaptive.threshold']

    def law(self, length: float, settling: float) -> EdgeLaw:
        """Return the law of springs with their limit, or what is left of the strain they had."""
        return limit_law(
            self._scene, max(self._scene['adaptive.threshold'], settling), length=length,
            transition=transition_of(self._scene), geometric=self._newton.beta)

    def take_over(self, last_length: float) -> None:
        """Go on after explicit substeps, the last of ``last_length`` [s]."""
        self.resume(last_length)
        # The limit has closed in on edges that store nothing at it.
        self._settled_from = self.settling.limit
