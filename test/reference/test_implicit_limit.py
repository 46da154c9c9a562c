# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Cloths that fall into their strain limit or hang at it, and springs against Newton.

A limit holds by the implicit step alone: nothing pays for energy, and nothing is smoothed.
"""

from cloth_sim_ros.reference.edge_law import limited_law
from cloth_sim_ros.reference.edge_law import spring_law
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.mode_runs import LIGHT_CLOTH
from force_tremor import SCENES
import numpy as np
import pytest
from scipy.integrate import solve_ivp

LIMIT = 0.01


def _strains(cloth: ImplicitCloth) -> np.ndarray:
    """Return |l / L0 - 1| of the edges that have a limit."""
    limited = np.isfinite(cloth.law.longest)
    return np.abs(cloth.law.edges.strains(cloth.positions.reshape(-1, 3)))[limited]


def _light_cloth(nodes: int, dt: float, stiffness: float = 1000.0) -> Scene:
    return Scene({
        'rows': nodes, 'cols': nodes, 'areal_density': 0.15, 'dt': dt,
        'stiffness.structural': stiffness, 'stiffness.shear': stiffness,
        'stiffness.bend': 0.5, 'constraint.strain': 1e-4})


@pytest.mark.parametrize(('nodes', 'dt'), [
    (8, 0.02), *(pytest.param(nodes, dt, marks=pytest.mark.long)
                 for nodes, dt in ((12, 0.02), (12, 0.01), (24, 0.01)))])
def test_a_falling_cloth_keeps_to_its_limit(nodes, dt):
    """A cloth that is caught passes its limit, or gains energy from it."""
    scene = _light_cloth(nodes, dt)
    cloth = ImplicitCloth(scene, limited_law(scene, LIMIT))
    start, weight = cloth.energies().total, 0.15 * 9.81
    strains, gains, substeps, solves = [], [], 0, 0
    for _ in range(round(1.2 / dt)):
        cloth.step()
        strains.append(_strains(cloth).max())
        gains.append((cloth.energies().total - start) / weight)
        substeps += cloth.report.substeps
        solves += cloth.report.solves
    peak, most = max(strains), np.quantile(strains, 0.95)
    print(f'measured: {nodes} x {nodes} dt {dt} strain {peak:.4%} at most, {most:.4%} in 95 %, '
          f'energy {max(gains):+.4f} {min(gains):+.4f} M g L, {substeps / 1.2:.0f} substeps and '
          f'{solves / 1.2:.0f} solves a second')
    assert peak <= LIMIT + 1e-3
    assert most <= LIMIT + 3e-4
    assert max(gains) <= 0.01


def test_the_light_cloth_of_the_study_keeps_to_its_limit():
    """The cloth that modes are compared on stretches beyond what the comparison allows."""
    scene = Scene({
        **LIGHT_CLOTH, 'rows': 12, 'cols': 12, 'dt': 0.02, 'adaptive.threshold': LIMIT,
        'stiffness.structural': 1000.0, 'stiffness.shear': 1000.0})
    cloth = ImplicitCloth(scene, limited_law(scene))
    start, weight = cloth.energies().total, scene.mass * 9.81
    strains, gains, settled = [], [], True
    for _ in range(round(1.2 / cloth.dt)):
        cloth.step()
        settled &= cloth.report.settled
        strains.append(_strains(cloth).max())
        gains.append((cloth.energies().total - start) / weight)
    peak, most = max(strains), np.quantile(strains, 0.95)
    print(f'measured: light cloth, strain {peak:.3%} at most, {most:.3%} in 95 % of the steps, '
          f'energy {max(gains):+.4f} {min(gains):+.4f} M g (1 m)')
    assert settled
    assert peak <= 2.0 * LIMIT
    assert most <= 1.2 * LIMIT
    assert max(gains) <= 0.01


@pytest.mark.parametrize('dt', [pytest.param(0.002, marks=pytest.mark.long), 0.02])
@pytest.mark.parametrize('name', [
    name for name, values in SCENES.items() if values.get('adaptive.threshold') == 0.02])
def test_a_strip_hangs_still_at_its_limit(name, dt):
    """The pins feel a cloth that rests at its limit tremble, or it passes the limit on its way."""
    scene = Scene({**SCENES[name], 'dt': dt})
    cloth = ImplicitCloth(scene, limited_law(scene))
    start, weight = cloth.energies().total, scene.mass * 9.81
    forces, strains, gains, settled = [], [], [], True
    for _ in range(round(2.0 / dt)):
        cloth.step()
        settled &= cloth.report.settled
        forces.append(cloth.reactions[..., 2].sum() / weight)
        strains.append(_strains(cloth).max())
        gains.append((cloth.energies().total - start) / weight)
    last = forces[len(forces) * 3 // 4:]
    print(f'measured: {name}, dt {dt}: pins feel {np.mean(last):.6f} of the weight and tremble by '
          f'{np.std(last):.1e} of it, strain {max(strains):.4%} at most, energy {max(gains):+.1e} '
          f'{min(gains):+.1e} M g (1 m)')
    assert settled
    assert np.mean(last) == pytest.approx(1.0, abs=1e-3)
    assert np.std(last) < 1e-3
    assert max(strains) <= 1.1 * scene['adaptive.threshold']
    # The limit carries what springs cannot, or this is about springs: from 0.9 of it on it does.
    assert max(strains) > 0.91 * scene['adaptive.threshold']
    assert max(gains) <= 0.0


def test_springs_converge_to_newton():
    """Implicit springs are not those of Newton's second law, to first order in dt."""
    scene = {'rows': 4, 'cols': 4, 'areal_density': 0.15, 'pins': ['top_left'],
             'gravity': [0.0, 0.0, 0.0], 'start.jitter': 0.2, 'stiffness.structural': 2.0,
             'stiffness.shear': 2.0, 'stiffness.bend': 0.2, 'damping.structural': 0.01,
             'auto_substeps': False}
    cloths = [
        ImplicitCloth(one, spring_law(one))
        for one in (Scene({**scene, 'dt': dt}) for dt in (0.002, 0.001, 0.0005))]
    edges, start = cloths[0].law.edges, cloths[0].positions.reshape(-1, 3)
    springs = list(zip(
        edges.first, edges.second, edges.rest_length, edges.stiffness, edges.damping))

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        places, speeds = state.reshape(2, -1, 3)
        forces = np.zeros_like(places)
        for one, other, rest, stiffness, damping in springs:
            apart = places[other] - places[one]
            length = np.sqrt(apart @ apart)
            grows = apart @ (speeds[other] - speeds[one]) / length
            pull = (stiffness * (length - rest) + damping * grows) * apart / length
            forces[one] += pull
            forces[other] -= pull
        forces[0] = 0.0
        return np.concatenate([speeds, forces / (0.15 / 16.0)]).ravel()

    exact = solve_ivp(
        rates, (0.0, 0.1), np.concatenate([start, 0.0 * start]).ravel(), method='DOP853',
        rtol=1e-9, atol=1e-9).y[:48, -1].reshape(4, 4, 3)
    errors = []
    for cloth in cloths:
        cloth.advance(0.1)
        errors.append(np.abs(cloth.positions - exact).max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    print(f'measured: off by {errors} m, orders {orders}')
    assert orders == pytest.approx(np.ones(2), abs=0.15)
