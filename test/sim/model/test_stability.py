# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The longest stable time step of explicit springs, and how many substeps they need."""

import math
import re

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.forces import Bending
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.stability import any_shape_limit
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.model.stability import safe_substep
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from hypothesis import given
from hypothesis import strategies
import numpy as np
from PIL import Image
import pytest
from scipy import ndimage
from scipy import sparse

_NODE_MASS = 0.01


def scene(stiffness: tuple[float, float, float], damping: float = 0.0, **more: object) -> Scene:
    """Return a square cloth with these stiffnesses (structural, shear, bend)."""
    values = {'node_mass': _NODE_MASS}
    for family, k in zip(('structural', 'shear', 'bend'), stiffness):
        values[f'stiffness.{family}'] = k
        values[f'damping.{family}'] = damping if k > 0.0 else 0.0
    return Scene({**values, **more})


@pytest.mark.parametrize(('stiffness', 'mu'), [
    ((100.0, 0.0, 0.0), 4.0), ((100.0, 100.0, 0.0), 8.0), ((100.0, 100.0, 100.0), 10.125)])
@pytest.mark.parametrize('damping', [0.0, 0.05, 2.0])
def test_equal_springs(stiffness: tuple, mu: float, damping: float):
    """The predicted limit would not be that of the closed form for one k_s and k_d."""
    k = 100.0
    closed = (-damping + math.sqrt(damping**2 + 4.0 * _NODE_MASS * k / mu)) / k
    assert stability_limit(scene(stiffness, damping)) == pytest.approx(closed, rel=1e-4)


@pytest.mark.parametrize(('ks', 'ksh', 'kb'), [
    (100.0, 50.0, 10.0), (100.0, 10.0, 1.0), (100.0, 0.0, 20.0), (100.0, 100.0, 400.0),
    (10.0, 200.0, 80.0)])
def test_different_springs(ks: float, ksh: float, kb: float):
    """The limit would be wrong where the families differ, the usual case."""
    axial_c = max(-1.0, min(0.0, -(ks + ksh) / (4 * kb)))
    axial = 2 * (ks + ksh) * (1 - axial_c) + 4 * kb * (1 - axial_c**2)
    diagonal_c = max(-1.0, min(0.0, -ks / (4 * (kb + ksh))))
    diagonal = 2 * ks * (1 - diagonal_c) + 4 * (kb + ksh) * (1 - diagonal_c**2)
    closed = 2.0 * math.sqrt(_NODE_MASS / max(axial, diagonal))
    assert stability_limit(scene((ks, ksh, kb))) == pytest.approx(closed, rel=1e-3)


def test_warp_and_weft():
    """The stiffer of both directions would not bound the step, or both would be added up."""
    cloth = scene((0.0, 0.0, 0.0), **{'stiffness.structural': [100.0, 300.0]})
    assert stability_limit(cloth) == pytest.approx(2.0 * math.sqrt(_NODE_MASS / 1200.0), rel=1e-6)
    assert any_shape_limit(cloth) == pytest.approx(2.0 * math.sqrt(_NODE_MASS / 1600.0), rel=1e-6)


def test_rigidity():
    """A stiff fabric would blow up, or be stepped as if folds made it stiffer."""
    cloth = scene((0.0, 0.0, 0.0), **{'bending.rigidity': 0.02, 'rows': 11, 'cols': 11})
    closed = 2.0 * math.sqrt(_NODE_MASS / (32.0 * 0.02 / 0.1**2))
    assert stability_limit(cloth) == pytest.approx(closed, rel=1e-6)
    assert any_shape_limit(cloth) == pytest.approx(closed, rel=1e-6)
    oblong = scene((0.0, 0.0, 0.0), **{
        'bending.rigidity': [0.03, 0.02], 'rows': 21, 'cols': 11})
    most = 16.0 * (0.03 * 0.05 / 0.1**3 + 0.02 * 0.1 / 0.05**3)
    assert stability_limit(oblong) == pytest.approx(2.0 * math.sqrt(_NODE_MASS / most), rel=1e-6)


def test_damped_rigidity():
    """A damped fabric would blow up where an undamped one is stable."""
    stiffness, time = 32.0 * 0.02 / 0.1**2, 0.004
    closed = 4.0 * _NODE_MASS / (
        time * stiffness + math.sqrt((time * stiffness)**2 + 4.0 * _NODE_MASS * stiffness))
    cloth = scene((0.0, 0.0, 0.0), **{
        'bending.rigidity': 0.02, 'bending.damping': time, 'rows': 11, 'cols': 11})
    assert stability_limit(cloth) == pytest.approx(closed, rel=1e-6)
    assert any_shape_limit(cloth) == pytest.approx(closed, rel=1e-6)


def test_a_chain_has_only_its_own_springs():
    """A chain would be stepped as finely as a sheet with shear and springs across."""
    chain = scene((100.0, 100.0, 0.0), rows=50, cols=1)
    assert stability_limit(chain) == pytest.approx(2.0 * math.sqrt(_NODE_MASS / 400.0), rel=1e-6)


def test_damping_lowers_the_limit():
    """Damping would be trusted to stabilise an explicit scheme, which it does not."""
    limits = [stability_limit(scene((100.0,) * 3, damping)) for damping in (0.0, 0.1, 1.0)]
    assert limits == sorted(limits, reverse=True)


def test_strong_damping_keeps_its_digits():
    """With much damping and little stiffness the limit would be lost in rounding."""
    soft = scene((1e-6, 0.0, 0.0), 100.0)
    assert stability_limit(soft) == pytest.approx(2.0 * _NODE_MASS / (4.0 * 100.0), rel=1e-6)


def test_no_springs_no_limit():
    """A cloud of free nodes would be refused every dt."""
    free = scene((0.0, 0.0, 0.0))
    assert stability_limit(free) == math.inf
    assert choose_substeps(free) == 1


@pytest.mark.parametrize(('stiffness', 'mu'), [
    ((100.0, 0.0, 0.0), 8.0), ((100.0, 100.0, 0.0), 12.0), ((100.0, 100.0, 100.0), 49.0 / 3.0)])
def test_the_limit_of_any_shape(stiffness: tuple, mu: float):
    """A cloth that folds would blow up, however carefully its flat limit is kept."""
    cloth = scene(stiffness)
    assert any_shape_limit(cloth) == pytest.approx(
        2.0 * math.sqrt(_NODE_MASS / (mu * 100.0)), rel=1e-4)
    assert safe_substep(cloth) <= min(any_shape_limit(cloth), 0.85 * stability_limit(cloth))


@pytest.mark.parametrize('ratio', [1.02, 1.48, 1.52, 1.98, 7.1])
def test_substeps_keep_to_the_share(ratio: float):
    """The automatic choice would come too near to the limit, or be wasteful."""
    dt = ratio * safe_substep(scene((1000.0,) * 3))
    cloth = scene((1000.0,) * 3, dt=dt)
    substeps = choose_substeps(cloth)
    assert dt / substeps <= safe_substep(cloth) <= 0.85 * stability_limit(cloth)
    assert dt / (substeps - 1) > safe_substep(cloth)


# A dt is refused with numbers that fit together, and with one that is accepted.

_NUMBER = '([0-9.e+-]+)'
_TOO_MANY = re.compile(
    f'dt {_NUMBER} s would take {_NUMBER} substeps of the {_NUMBER} s that are safe in any shape'
    f'(?:, times refine {_NUMBER})?, more than 100000: (?:set dt <= {_NUMBER}, or )?use softer')
_TOO_LONG = re.compile(
    f'dt {_NUMBER} s in {_NUMBER} substeps is above the stability limit {_NUMBER} s of a substep '
    f'in mode mass_spring [(]node mass {_NUMBER} kg[)], and {_NUMBER} s are safe in any shape: '
    f'(?:set dt <= {_NUMBER}, or )?')
_STIFF = {'stiffness.structural': 1e9, 'node_mass': 1e-3}
_DTS = strategies.sampled_from([1e-7, 2e-4, 0.005, 0.02, 0.3, 1.0])
_SPRINGS = strategies.fixed_dictionaries({
    'stiffness.structural': strategies.floats(1.0, 1e9),
    'stiffness.shear': strategies.floats(0.0, 1e6), 'damping.bend': strategies.floats(0.0, 1e6),
    'node_mass': strategies.floats(1e-9, 1.0)})


def refusal(values: dict) -> str:
    """Return the message with which the scene is refused; empty when it is accepted."""
    try:
        spring_substeps(Scene(values), 'mass_spring')
    except ClothSimError as error:
        return str(error)
    return ''


def numbers(pattern: re.Pattern, message: str) -> list[float]:
    """Return the numbers in ``message``; 0 where one is left out."""
    found = pattern.match(message)
    assert found, message
    return [float(text or 0.0) for text in found.groups()]


@given(springs=_SPRINGS, dt=_DTS, refine=strategies.sampled_from([1, 2, 7, 1000]))
def test_too_many_substeps(springs: dict, dt: float, refine: int):
    """The count would not be that of the substep beside it, or the dt offered be refused too."""
    values = {**springs, 'dt': dt, 'refine': refine}
    message = refusal(values)
    if not message:
        return
    _, count, safe, times, offered = numbers(_TOO_MANY, message)
    assert times == (refine if refine > 1 else 0)
    assert count == float(f'{refine * math.ceil(dt / safe - 1e-9):.3g}')
    longest = safe * (100000 // refine)
    if longest < 1e-7:
        assert not offered
        return
    assert offered == pytest.approx(longest, rel=0.011)
    assert refusal({**values, 'dt': offered}) == ''


@given(springs=_SPRINGS, dt=_DTS, substeps=strategies.sampled_from([1, 3, 7, 1000]))
def test_too_long_substeps(springs: dict, dt: float, substeps: int):
    """The dt offered would be refused too, or come out of nowhere."""
    values = {**springs, 'dt': dt, 'auto_substeps': False, 'substeps': substeps}
    message = refusal(values)
    if not message:
        return
    _, _, limit, _, safe, offered = numbers(_TOO_LONG, message)
    assert dt / substeps > limit
    if safe * substeps < 1e-7:
        assert not offered
    else:
        assert offered == pytest.approx(safe * substeps, rel=0.011)
        assert refusal({**values, 'dt': offered}) == ''
    automatic = refusal({**values, 'auto_substeps': True})
    assert ('auto_substeps: true' in message) == (automatic == '')


def test_the_usual_numbers():
    """The user would be shown a substep that twice as many would be made of."""
    assert refusal({**_STIFF, 'dt': 1.0}) == (
        'dt 1 s would take 1.41e+06 substeps of the 7.07e-07 s that are safe in any shape, more '
        'than 100000: set dt <= 0.0707, or use softer springs, less damping or a larger node '
        'mass')


def random_fabric(random: np.random.Generator, rows: int, cols: int, **more: object) -> Scene:
    """Return a fabric with random stiffness, bending and damping."""
    warp, weft = (float(10.0**random.uniform(1.0, 4.0)) for _ in range(2))
    width, height = (float(side) for side in random.uniform(0.2, 1.0, 2))
    ratio = width / (cols - 1) / height * (rows - 1)
    return Scene({
        'rows': rows, 'cols': cols, 'width': width, 'height': height, 'material.preset': 'none',
        'areal_density': 0.2, 'air.density': 0.0, 'material.warp': warp, 'material.weft': weft,
        'material.shear': float(random.uniform(0.0, 0.9)) * min(warp / ratio**2, weft * ratio**2),
        'stiffness.bend': float(random.choice([0.0, 300.0])),
        'bending.rigidity': float(random.choice([0.0, 1e-3])),
        **{f'damping.{family}': float(random.choice([0.0, 0.05]))
           for family in ('structural', 'shear', 'bend')}, **more})


def largest_growth(scene: Scene) -> float:
    """Return the largest eigenvalue of a substep at the limit, over that which is stable."""
    edges, flat = edges_of(scene), scene.rest_positions().reshape(-1, 3)
    jacobian = edges.jacobian(edges.directions(flat), len(flat))
    stiff, damped = (
        (jacobian.T @ sparse.diags(weights) @ jacobian).toarray()
        for weights in (edges.stiffness, edges.damping))
    stiff += np.kron(Bending(scene).matrix.toarray(), np.eye(3))
    limit, shares = stability_limit(scene), scene.node_shares.ravel()
    roots = np.repeat(np.where(shares > 0.0, shares, np.inf)**-0.5, 3)
    matrix = roots[:, None] * (limit**2 * stiff + 2.0 * limit * damped) * roots
    return float(np.linalg.eigvalsh(matrix)[-1] / (4.0 * scene.node_mass))


@pytest.mark.parametrize('seed', range(30))
def test_a_fabric_is_stable_at_its_limit(seed):
    """At corners and borders, where nodes are light, a wave could grow below the limit."""
    random = np.random.default_rng(seed)
    rows, cols = (int(count) for count in random.integers(2, 9, 2))
    scene = random_fabric(random, rows, cols)
    assert scene.cells is not None
    assert 0.55 < largest_growth(scene) <= 1.0 + 1e-9


@pytest.mark.parametrize('seed', range(30))
def test_a_cut_fabric_is_stable_at_its_limit(seed, tmp_path):
    """At corners of holes, where nodes are light, a wave could grow below the limit."""
    random = np.random.default_rng(seed)
    rows, cols = (int(count) for count in random.integers(5, 9, 2))
    # One piece of most of the cells.
    parts, _ = ndimage.label(random.uniform(size=(rows - 1, cols - 1)) < 0.8)
    mask = parts == np.argmax(np.bincount(parts[parts > 0]))
    Image.fromarray(mask).save(tmp_path / 'mask.png')
    scene = random_fabric(
        random, rows, cols, **{'shape.mask': str(tmp_path / 'mask.png'), 'pins': ['none']})
    assert np.array_equal(scene.cells.present, mask)
    assert 0.4 < largest_growth(scene) <= 1.0 + 1e-9
