# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Chains of one, two and three hard links that fall from level, against rigid links."""

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.rigid_links import fall_from_level
from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

LINK = 0.5


def _chain(links: int, dt: float, **values) -> ImplicitCloth:
    """Return a chain of links of 0.5 m, held at its left end, level and at rest."""
    return ImplicitCloth(Scene({
        'rows': 1, 'cols': links + 1, 'width': LINK * links, 'node_mass': 0.1,
        'pins': ['top_left'], 'dt': dt, **values}))


def _energy_span(chain: ImplicitCloth, seconds: float) -> tuple[float, float]:
    """Return the least and the most of kinetic and potential energy since the start, in M g L."""
    def mechanical() -> float:
        # Velocities belong to half a substep before: up to 0.62 sqrt(g / 2 L) h of M g L by that.
        half = 0.5 * chain.dt / max(chain.report.substeps, 1) if chain.steps else 0.0
        pulls = edges.scatter(
            chain.tension[:, None] * edges.directions(chain.positions[0]), chain.scene.cols)
        speeds = chain.velocities[0, 1:] + half * (chain.gravity - pulls[1:] / 0.1)
        return 0.05 * np.sum(speeds**2) + chain.energies().gravitational

    edges = chain.law.edges

    links = chain.scene.cols - 1
    start, scale = mechanical(), 0.1 * links * GRAVITY * LINK * links
    changes = []
    for _ in range(round(seconds / chain.dt)):
        chain.step()
        changes.append((mechanical() - start) / scale)
    least, most = min(changes), max(changes)
    print(f'measured: {links} links dt {chain.dt} {seconds:g} s energy {least:+.4f} {most:+.4f} '
          f'M g L, lengths off by {chain.excess():.1e}')
    return least, most


@pytest.mark.parametrize(
    'links', [*(pytest.param(links, marks=pytest.mark.long) for links in (1, 2)), 3])
@pytest.mark.parametrize(('dt', 'gain', 'seconds'), [
    (0.02, 0.02, 20.0), (0.01, 1e-3, 6.0),
    pytest.param(0.01, 1e-3, 20.0, marks=pytest.mark.long),
    pytest.param(0.005, 1e-3, 20.0, marks=pytest.mark.long),
    pytest.param(0.002, 1e-3, 20.0, marks=pytest.mark.long)])
def test_energy_of_a_swinging_chain(links, dt, gain, seconds):
    """A chain in free swing gains energy, or is damped by more than 9 % (8 % at 0.01)."""
    least, most = _energy_span(_chain(links, dt), seconds)
    assert most <= gain
    assert least >= (-0.08 if dt == 0.01 else -0.09)


@pytest.mark.parametrize('links', [1, 2, 3])
def test_converges_to_rigid_links(links):
    """The chain is not that of Lagrange's equations, to first order in dt."""
    times = np.array([0.0, 0.2, 0.4, 0.6])
    exact = fall_from_level(links, LINK, times)
    errors = []
    for dt in (0.01, 0.005, 0.0025):
        # All but rigid, as the links that it is compared with.
        chain = _chain(links, dt, auto_substeps=False, **{'constraint.strain': 1e-4})
        worst = 0.0
        for before, now, places in zip(times, times[1:], exact[1:]):
            chain.step(round((now - before) / dt))
            offsets = chain.positions[0, 1:] - chain.positions[0, 0]
            worst = max(worst, np.abs(offsets[:, [0, 2]] - places).max())
        errors.append(worst)
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    print(f'measured: {links} links off by {errors} m, orders {orders}')
    assert orders == pytest.approx(np.ones(2), abs=0.1)
