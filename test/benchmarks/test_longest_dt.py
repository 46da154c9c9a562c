# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Up to which dt methods hold: what docs/notes/paper.md says of the paper's limits."""

from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.paper_figures import PAPER_ADAPTIVE
from cloth_sim_ros.study.paper_figures import PAPER_CONSTRAINT
from cloth_sim_ros.study.paper_figures import paper_scene_file
from cloth_sim_ros.study.paper_figures import STIFF
from longest_dt import holds
from longest_dt import pushed_cloth
from longest_dt import run_at
import pytest

CLOTH = pushed_cloth(12, 5.0)
SECONDS = 2.2


def springs(stiffness):
    """Return what makes all springs as stiff as that, stepped without substeps."""
    return {
        'mode': 'mass_spring', 'auto_substeps': False,
        **{f'stiffness.{family}': stiffness for family in ('structural', 'shear', 'bend')}}


def test_the_cloth_is_that_of_the_scene_file():
    """The table would be of another cloth than the pictures."""
    values = load_parameters(paper_scene_file())
    force = values.pop('pushes.force')
    assert CLOTH['pushes.force'] == pytest.approx(force)
    assert {name: CLOTH.get(name, value) for name, value in values.items()} == values


@pytest.mark.parametrize('stiffness', [1000.0, STIFF])
def test_mass_spring_stability_limit(stiffness):
    """The limit of stability.py is not what makes the paper's mass-spring cloth blow up."""
    changes = springs(stiffness)
    limit = stability_limit(Scene({**CLOTH, **changes}))
    below, above = (
        run_at(CLOTH, changes, share * limit, SECONDS) for share in (0.95, 1.15))
    print(f'measured: limit {limit:.5f} s; below it a strain of {below.max_strain:.3g} and '
          f'{below.peak_kinetic_energy:.4g} J; above it '
          + (f'{above.peak_kinetic_energy:.3g} J' if above.finite else 'not finite'))
    assert below.finite
    assert below.max_strain < 1.0
    assert below.peak_kinetic_energy < 6e3
    assert not above.finite or above.peak_kinetic_energy > 1e6


def test_the_project_holds_where_the_papers_schemes_do_not():
    """docs/notes/paper.md says that the limits of 0.01 and 0.02 s have moved."""
    for mode, allowed, theirs in (
            ('constraint', 0.0, PAPER_CONSTRAINT), ('adaptive', 0.1, PAPER_ADAPTIVE)):
        short = run_at(CLOTH, {'mode': mode}, 0.01, SECONDS)
        assert holds(run_at(CLOTH, {'mode': mode}, 0.02, SECONDS), allowed, short)
        assert not holds(run_at(CLOTH, theirs, 0.02, SECONDS), allowed, short)


def test_paper_adaptive_fails_at_short_steps():
    """docs/notes/paper.md: a shorter step makes it worse, since edges come back faster."""
    long, short = (
        run_at(CLOTH, PAPER_ADAPTIVE, dt, SECONDS).peak_kinetic_energy for dt in (0.01, 0.005))
    print(f'measured: {short:.3g} J at dt 0.005 s, {long:.3g} J at 0.01 s')
    assert long < 8e3
    assert short > 3.0 * long
