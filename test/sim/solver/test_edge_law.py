# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The law of the edges has the compliance, the limits and the weights that it says."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import full_pull
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
import pytest
from springs import SPRINGS

CLOTH = {
    **SPRINGS,
    'rows': 41, 'cols': 51, 'width': 2.0, 'height': 1.0, 'node_mass': 0.002,
    'stiffness.structural': 100.0, 'stiffness.shear': 50.0, 'stiffness.bend': 2.0,
    'damping.structural': 0.1, 'damping.shear': 0.2, 'damping.bend': 0.03}
WEIGHT = 41 * 51 * 0.002 * 9.81
# Along a row, a column, the diagonal, and two along each [m].
REST = (0.04, 0.025, (0.04**2 + 0.025**2)**0.5, 0.08, 0.05)


@pytest.mark.parametrize('strain', [0.01, 0.002])
@pytest.mark.parametrize('rest', range(3))
def test_edge_carrying_the_weight_stretches_as_set(strain, rest):
    """A cloth that hangs by a corner would stretch more, or less, than the scene sets."""
    law = hard_edges(Scene(CLOTH), 0.01, strain=strain)
    assert law.limit_stiffness[rest] * 0.002 * strain * REST[rest] == pytest.approx(WEIGHT)


@pytest.mark.parametrize(('rows', 'cols', 'times'), [
    (12, 20, 1.0 / 0.36), (20, 12, 1.0 / 0.36), (1, 30, 1.0 / 0.03), (40, 40, 1.0)])
def test_a_cloth_of_few_lines_is_harder(rows, cols, times):
    """A narrow cloth would stretch more than a wide one where it hangs by a whole edge."""
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'node_mass': 0.5})
    weight = rows * cols * 0.5 * 9.81
    assert full_pull(scene, 0.01) == pytest.approx(weight / 0.01 * times)


def test_the_law_belongs_to_the_scene():
    """The energy of a cloth would jump when the step changes, or hang on the gravity there."""
    scene = Scene(CLOTH)
    law, shorter = (edge_law(scene, length, hard=['structural']) for length in (0.01, 0.001))
    floating = edge_law(Scene({
        **SPRINGS, **CLOTH, 'gravity': [0.0, 0.0, 0.0]}), 0.01, hard=['structural'])
    for other in (shorter, floating):
        assert other.limit_stiffness == law.limit_stiffness
        assert other.stiffness == law.stiffness
        assert other.damping == law.damping


def test_hard_edges_have_no_spring_besides():
    """An edge would be reported stiffer than it is, or be damped where it should not be."""
    law = edge_law(Scene(CLOTH), 0.01, hard=['structural'], springs=['structural', 'bend'])
    assert law.stiffness == (0.0, 0.0, 0.0, *[pytest.approx(1000.0)] * 2)
    assert law.damping == (0.0, 0.0, 0.0, *[pytest.approx(15.0)] * 2)
    assert law.shortest[0] == law.longest[0] == 1.0


def test_limits_are_those_asked_for():
    """A limit would hold on one side alone, at another strain, or where there is none."""
    law = edge_law(Scene(CLOTH), 0.01, limited=['structural', 'shear'], limit=0.05)
    for family in (0, 1):
        assert (law.shortest[family], law.longest[family]) == pytest.approx((0.95, 1.05))
    assert law.shortest[2] <= 0.0 and law.longest[2] >= 1e9
    wide = edge_law(Scene(CLOTH), 0.01, limited=['shear'], limit=1.5)
    assert wide.shortest[1] <= 0.0 and wide.longest[1] == pytest.approx(2.5)


def test_weights_of_springs():
    """The smoothing and the coarsest level would be made for other edges."""
    law = spring_law(Scene(CLOTH), 0.01)
    structural, shear, bend = (
        (1e-4 * k + 1e-2 * d) / 0.002 for k, d in ((100.0, 0.1), (50.0, 0.2), (2.0, 0.03)))
    assert law.weights == pytest.approx((structural, structural, shear, bend, bend))
    assert law.largest_weight == pytest.approx(structural)


def test_weights_of_hard_edges():
    """Edges that are short, and so stiffer, would weigh too little, or bend springs something."""
    law = hard_edges(Scene(CLOTH), 0.01, strain=0.01)
    pull = WEIGHT / 0.01
    assert law.weights == pytest.approx(
        [*(1e-4 * pull / (rest * 0.002) for rest in REST[:3]), 0.0, 0.0])
    assert law.largest_weight == pytest.approx(law.weights[1])


def test_a_limit_counts_in_the_weights():
    """An edge at its limit would weigh more than the smoothing is made for."""
    law = edge_law(Scene(CLOTH), 0.01, limited=['shear'], limit=0.05)
    springs = spring_law(Scene(CLOTH), 0.01)
    assert law.weights[2] == pytest.approx(springs.weights[2] + 1e-4 * law.limit_stiffness[2])
    assert law.weights[:2] == springs.weights[:2]
