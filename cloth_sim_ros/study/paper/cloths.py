# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloths of the paper's Table 10 and section 5, and the states they are timed in."""

from dataclasses import dataclass
import sys
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.stability import safe_substep
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.paper.printed import edge_count
from cloth_sim_ros.study.paper.printed import printed_speeds
from cloth_sim_ros.study.paper.printed import PrintedSpeed
from cloth_sim_ros.study.speed import bench_scene
import numpy as np

_CONSTRAINT_DT = 0.005
# [N/m]; a cloth of 0.2 kg falls into its two corners, and up to some 300 edges reach 10 %. With
# softer springs more of them do, and the paper's scheme throws thousands beyond the limit
# (docs/notes/paper.md).
_STIFFNESS = 100.0
_DAMPING_TIME = 1e-4  # [s]
_BEND_SHARE = 0.1
_DRAPE_SECONDS = 0.5
# Nodes per side of the coarse cloth whose draped state a finer one in mode adaptive starts from,
# which takes seconds instead of minutes; _OWN_STEPS steps follow.
_COARSE = 32
# Springs cost the same in any state.
_MOST_STEPS = {'constraint': 20, 'adaptive': 5}
_OWN_STEPS = 5

State = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class PaperCloth:
    """
    One cloth to time.

    :param method: mass_spring, constraint or adaptive
    :param families: its edges; in method constraint those that keep their length
    """

    method: str
    rows: int
    cols: int
    families: tuple[str, ...] = FAMILIES

    @property
    def nodes(self) -> int:
        """Return how many nodes it has."""
        return self.rows * self.cols

    @property
    def springs(self) -> int:
        """Return how many edges it has."""
        return edge_count(self.rows, self.cols, self.families)

    @property
    def printed(self) -> PrintedSpeed | None:
        """Return what the paper prints for it; None where that is nothing."""
        return next((
            speed for speed in printed_speeds()
            if (speed.method, speed.nodes, speed.springs)
            == (self.method, self.nodes, self.springs)), None)

    @property
    def most_steps(self) -> int:
        """Return how many steps from its start are timed: the states are to stay alike."""
        return _MOST_STEPS.get(self.method, sys.maxsize)

    def scene(self, **changes: Any) -> Scene:
        """
        Return the scene, of one step a frame.

        Mass-spring: the moving cloth of ``cloth_sim bench``. The others: a cloth of 1 x 1 m and
        0.2 kg/m2 that falls into its two corners.
        """
        if self.method == 'mass_spring':
            return bench_scene(self.rows, {'cols': self.cols, 'mode': self.method, **changes})
        values = {
            'mode': self.method, 'rows': self.rows, 'cols': self.cols, 'material.preset': 'none',
            'constraint.hard': self.families if self.method == 'constraint' else FAMILIES[:2],
            **{f'stiffness.{family}': share * _STIFFNESS for family, share in _SHARES.items()},
            **{f'damping.{family}': share * _DAMPING_TIME * _STIFFNESS
               for family, share in _SHARES.items()}}
        dt = _CONSTRAINT_DT if self.method == 'constraint' else safe_substep(Scene(values))
        return Scene({**values, 'dt': dt, **changes})

    def start(self, context: Context) -> State:
        """Return positions [m] and velocities [m/s], (rows, cols, 3), that it is timed from."""
        if self.method == 'mass_spring':
            positions = self.scene().start_positions()
            return positions, np.zeros_like(positions)
        if self.method == 'constraint' or max(self.rows, self.cols) <= _COARSE:
            return _draped(self.scene(dt=_CONSTRAINT_DT), context)
        coarse = PaperCloth(self.method, _COARSE, _COARSE, self.families)
        state = coarse.start(context)
        with Simulation(self.scene(), context=context) as run:
            run.set_state(*(_refined(field, self.rows, self.cols) for field in state))
            run.step(_OWN_STEPS)
            return run.positions(), run.velocities()


_SHARES = {'structural': 1.0, 'shear': 1.0, 'bend': _BEND_SHARE}


def _draped(scene: Scene, context: Context) -> State:
    with Simulation(scene, context=context) as run:
        run.advance(_DRAPE_SECONDS)
        return run.positions(), run.velocities()


def _refined(field: np.ndarray, rows: int, cols: int) -> np.ndarray:
    """Return ``field`` (n, m, 3) on ``rows`` x ``cols`` nodes, by cubic splines."""
    # The other cloths do without SciPy.
    from scipy.interpolate import RectBivariateSpline
    down, right = (np.linspace(0.0, 1.0, count) for count in field.shape[:2])
    return np.stack([
        RectBivariateSpline(down, right, part)(
            np.linspace(0.0, 1.0, rows), np.linspace(0.0, 1.0, cols))
        for part in np.moveaxis(field, -1, 0)], axis=-1)


def square(method: str, side: int, families: tuple[str, ...] = FAMILIES) -> PaperCloth:
    """Return a cloth with ``side`` nodes along each side."""
    return PaperCloth(method, side, side, families)


TWO_FAMILIES = ('structural', 'shear')
# Cloths of the paper's table with 10 rows, in its order; 147,456 nodes are 384 x 384.
TABLE_10 = (
    *(square('mass_spring', side) for side in (384, 512, 640, 768, 896)),
    *(square('constraint', side) for side in (12, 14, 16, 18, 20)))
# The largest cloths in real time by section 5.
LIMITS = (
    PaperCloth('mass_spring', 2048, 2560), square('constraint', 52, TWO_FAMILIES),
    square('adaptive', 128))
# The paper prints curves without numbers: sizes between those it names.
FIGURE_7 = (*TABLE_10[:5:2], square('mass_spring', 1448), LIMITS[0])
FIGURE_8 = (
    *TABLE_10[5:], *(square('constraint', side, TWO_FAMILIES) for side in (12, 20, 34, 52)))
FIGURE_9 = tuple(square('adaptive', side) for side in (32, 64, 96, 128))
