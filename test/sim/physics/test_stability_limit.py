# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The predicted longest step: below it nothing grows, above it everything does."""

from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

STIFFNESS = 100.0
# Each node moves this much of the spacing at the start. Strains that stay near it are calm; a
# cloth that blows up may end in a violent motion of bounded strain before it ends in NaN.
JITTER = 1e-4
CALM = 30.0 * JITTER
BLOWN_UP = 3000.0 * JITTER


def _values(mode, nodes, damping_ratio, shear, bend):
    mass = 0.2 / nodes**2
    # The ratio is that of the stiffest wave, mu k = 10 k or so.
    damping = 2.0 * damping_ratio * np.sqrt(STIFFNESS * mass / 10.0)
    return {
        'mode': mode, 'rows': nodes, 'cols': nodes, 'gravity': [0.0, 0.0, 0.0],
        'stiffness.structural': STIFFNESS, 'damping.structural': damping,
        'stiffness.shear': STIFFNESS * shear, 'damping.shear': damping * shear,
        'stiffness.bend': STIFFNESS * bend, 'damping.bend': damping * bend,
        'start.jitter': JITTER, 'auto_substeps': False}


def _strain_after(simulate, values, over_limit, steps):
    dt = over_limit * stability_limit(Scene(values))
    simulation = simulate({**values, 'dt': dt}, check_stability=False, stop_at_non_finite=False)
    simulation.step(steps)
    snapshot = simulation.snapshot()
    return snapshot.max_strain if snapshot.finite else np.inf


# Fine cloth with no damping and with the most of it, and coarse cloth with all between.
@pytest.mark.parametrize(('nodes', 'damping_ratio'), [
    pytest.param(nodes, ratio, marks=pytest.mark.long)
    if nodes in (24, 48) or nodes == 64 and 0.0 < ratio < 5.0 else (nodes, ratio)
    for nodes in (12, 24, 48, 64) for ratio in (0.0, 0.05, 0.2, 1.0, 5.0)])
def test_limit_separates_calm_from_blow_up(simulate, unlimited_mode, nodes, damping_ratio):
    """The limit is too high, or so low that it costs steps for nothing."""
    values = _values(unlimited_mode, nodes, damping_ratio, shear=1.0, bend=1.0)
    calm = _strain_after(simulate, values, 0.85, 2000)
    blown = _strain_after(simulate, values, 1.1, 2000)
    print(f'measured strain {calm:.1e} at 0.85, {blown:.1e} at 1.1 of the limit')
    assert calm < CALM
    assert blown > BLOWN_UP


@pytest.mark.parametrize(('shear', 'bend'), [(1.0, 0.1), (0.0, 0.0), (0.5, 4.0), (4.0, 0.0)])
@pytest.mark.parametrize('damping_ratio', [0.0, 1.0])
def test_limit_for_unlike_families(simulate, unlimited_mode, shear, bend, damping_ratio):
    """The limit is right only where all families are alike."""
    values = _values(unlimited_mode, 24, damping_ratio, shear, bend)
    values.update({'rows': 20, 'width': 1.3})
    assert _strain_after(simulate, values, 0.85, 2000) < CALM
    assert _strain_after(simulate, values, 1.1, 2000) > BLOWN_UP


def test_a_hard_push_does_not_blow_up(simulate, within, unlimited_mode):
    """Automatic substeps hold for a cloth at rest only, not for one stretched to its double."""
    nodes = 32
    weight = 0.2 * 9.81 * (1.0 - 2.0 / nodes**2)
    simulation = simulate({
        'mode': unlimited_mode, 'rows': nodes, 'cols': nodes, 'dt': 0.02, 'pushes.start': [0.5],
        'pushes.duration': [0.2], 'pushes.force': [0.0, 0.0, 20.0 * weight]})
    simulation.advance(0.7)
    pushed = simulation.measure()
    strains = []
    for _ in range(20):
        simulation.advance(0.1)
        strains.append(simulation.measure().max_strain)
    after = simulation.measure()
    assert after.finite
    assert max(strains) > 1.0
    within('energy 2 s after a push of 20 g, over that at its end',
           after.total_energy / pushed.total_energy, 1.0)


@pytest.mark.parametrize('damping', [0.0, pytest.param(0.003, marks=pytest.mark.long)])
@pytest.mark.parametrize('dt', [0.005939, pytest.param(0.011878, marks=pytest.mark.long)])
def test_folds_do_not_blow_up(simulate, within, mode, dt, damping):
    """Automatic substeps hold for flat cloth only: folds of one without shear blow up."""
    simulation = simulate({
        'mode': mode, 'rows': 32, 'cols': 32, 'dt': dt, 'start.jitter': 0.002,
        'stiffness.shear': 0.0, 'stiffness.bend': 0.0, 'damping.structural': damping,
        'damping.shear': 0.0, 'damping.bend': 0.0})
    start = simulation.measure().total_energy
    energies = []
    for _ in range(50):
        simulation.advance(0.1)
        energies.append(simulation.measure().total_energy)
    within('energy of a falling cloth without shear, over that at the start',
           np.max(energies) / start, 1.1)
