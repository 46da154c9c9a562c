# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What each part of an implicit step is for: a falling cloth in fixed steps, with and without."""

from cloth_sim_ros.reference.edge_law import constraint_law
from cloth_sim_ros.reference.edge_law import limited_law
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


def _fall(nodes: int, passes: Passes, limit: float | None, dt: float = 0.01) -> tuple[float, ...]:
    """Return the largest excess, and the most and least energy in M g L, within 1.2 s."""
    scene = Scene({
        'rows': nodes, 'cols': nodes, 'areal_density': 0.15, 'dt': dt, 'start.jitter': 1e-3,
        'stiffness.structural': 1000.0, 'stiffness.shear': 1000.0, 'stiffness.bend': 0.5,
        'constraint.strain': 1e-4, 'auto_substeps': False})
    law = constraint_law(scene) if limit is None else limited_law(scene, limit)
    cloth = ImplicitCloth(scene, law, passes=passes)
    start, excess, changes, solves = cloth.energies().total, [], [], 0
    for _ in range(round(1.2 / dt)):
        cloth.step()
        excess.append(cloth.excess())
        changes.append((cloth.energies().total - start) / (0.15 * 9.81))
        solves += cloth.report.solves
        if excess[-1] > 1.0:
            break
    print(f'measured: {nodes} x {nodes} limit {limit} dt {dt} {passes} excess {max(excess):.2e}, '
          f'{np.quantile(excess, 0.95):.1e} in 95 %, energy {max(changes):+.3g} '
          f'{min(changes):+.3g} M g L, {solves / len(excess):.1f} solves a step')
    return max(excess), max(changes), min(changes)


def test_the_pull_across_edges_holds_a_cloth_together():
    """A fixed step of 0.02 s blows up with K_geo in the matrix, or holds without it."""
    assert _fall(8, Passes(), None, 0.02)[0] < 0.01
    assert _fall(8, Passes(beta=0.0), None, 0.02)[0] > 1.0


def test_the_line_search_finds_which_limits_are_in_force():
    """Limits that change in every solve throw a cloth about."""
    excess, most, _ = _fall(8, Passes(), 0.01)
    assert excess < 1e-3
    assert most < 0.01


@pytest.mark.long
@pytest.mark.parametrize('limit', [None, 0.01])
@pytest.mark.parametrize('passes', [
    Passes(1, 0), Passes(2, 0), Passes(1, 1), Passes(2, 1), Passes(1, 2), Passes(2, 2),
    Passes(foresees_turn=False), Passes(solves=1), Passes(solves=2), Passes(solves=4),
    Passes(beta=0.0), Passes(beta=0.25), Passes(beta=1.0)], ids=str)
def test_passes(passes, limit):
    """Whatever the passes, a cloth that is caught in fixed steps gives a number to report."""
    assert np.isfinite(_fall(12, passes, limit)).all()
