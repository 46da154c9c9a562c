# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which runs a study of the trade is made of."""

from dataclasses import dataclass

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import choose_substeps
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.variant import Variant

_TRAJECTORY = 'cloth_sim_ros.study.trade.trajectory:trajectory'
_REFERENCE = 'cloth_sim_ros.study.trade.spring_reference:spring_reference'
_COST = 'cloth_sim_ros.study.trade.cost:cost'


@dataclass(frozen=True)
class Plan:
    """The runs of ``grid`` on ``scene``."""

    scene: Scene
    grid: Grid

    def trajectory(self, variant: Variant, setting: Setting) -> Run:
        """Return the run that the error of ``setting`` is measured on."""
        return Run(
            _TRAJECTORY, {**variant.values(self.scene), **setting.values}, self._times)

    def references(self, variant: Variant) -> list[Run]:
        """Return the runs of the springs of ``variant``, coarse to fine, to extrapolate from."""
        values = {
            **variant.values(self.scene), 'mode': 'mass_spring', 'auto_substeps': True,
            'dt': self.grid.frame}
        scene = Scene(values)
        frames = self.grid.times[-1] / self.grid.frame
        work = sum(self.grid.reference_refine) * frames * choose_substeps(
            Scene({**values, 'refine': 1})) * scene.node_count
        fits = work <= self.grid.float64_node_steps and not scene['pin_moves.start']
        return [
            Run(_REFERENCE if fits else _TRAJECTORY, {**values, 'refine': refine}, self._times)
            for refine in self.grid.reference_refine]

    def cost(self, variant: Variant, settings: list[Setting]) -> Run:
        """Return the run that measures the wall time of ``settings``, in turn."""
        return Run(_COST, variant.values(self.scene), {
            'settings': [setting.values for setting in settings],
            'seconds': self.grid.times[-1], 'frame': self.grid.frame,
            'rounds': self.grid.rounds})

    @property
    def _times(self) -> dict[str, object]:
        return {'times': list(self.grid.times), 'frame': self.grid.frame}
