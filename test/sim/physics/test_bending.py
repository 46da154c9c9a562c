# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A strip with a rigidity bends as a thin plate does, whatever its grid.

A node stands for a whole cell. Two lines of pinned nodes clamp a strip half way between them, and
it ends half a cell beyond its last line: so its free length is its width.
"""

from momenta import momenta
import numpy as np
import pytest

RIGIDITY = 2e-4  # N m
DENSITY = 0.2    # kg/m2
LENGTH = 0.2     # m
DEFLECTION = 0.01
# beta L and sigma of the first mode of a beam that is clamped at one end [1].
MODE, SHAPE = 1.8751041, 0.7340955
# Rigidity along rows and columns does not resist twisting: a strip of hard edges tips over.
SPRINGS = {'constraint.hard': [], 'constraint.springs': ['structural', 'shear']}


@pytest.fixture
def strip(simulate, any_mode):
    """Return a function to a strip along rows or columns, and the places of its nodes [m]."""

    def start(nodes, lines=1, axis=1, **values):
        cell = LENGTH / (nodes - 1)
        # A single line has the whole height for the height of its cells.
        height = cell * max(lines - 1, 1)
        size = {'cols': nodes, 'rows': lines, 'width': LENGTH, 'height': height}
        if axis == 0:
            size = {'rows': nodes, 'cols': lines, 'height': LENGTH, 'width': height}
        held = [f'{line},{place}' if axis == 1 else f'{place},{line}'
                for line in range(lines) for place in (0, 1)]
        simulation = simulate({
            'mode': any_mode, **size, 'node_mass': DENSITY * cell**2, 'pins': held,
            'bending.rigidity': RIGIDITY, 'start.z': 0.0, 'solver.tolerance': 1e-4,
            'stiffness.structural': 1.0, 'stiffness.shear': 1.0, 'stiffness.bend': 0.0, **SPRINGS,
            **{f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}, **values})
        return simulation, cell * (np.arange(nodes) - 0.5)

    return start


def _bend(simulation, shape, axis=1):
    """Deflect the strip by ``shape`` of its free nodes [m]."""
    shape = np.where(np.arange(len(shape)) < 2, 0.0, shape)
    positions = simulation.scene.rest_positions()
    positions[..., 2] += shape if axis == 1 else shape[:, None]
    simulation.set_state(
        positions.astype(np.float32), np.zeros(positions.shape, dtype=np.float32))


def _tip(simulation, axis=1):
    """Return the deflection of the end, half a cell beyond the last nodes [m]."""
    height = simulation.positions()[..., 2].astype(float)
    last, before = (height[..., -1], height[..., -2]) if axis == 1 else (height[-1], height[-2])
    return float(np.mean(1.5 * last - 0.5 * before))


def _period():
    """Return that of the first mode [s]."""
    return 2.0 * np.pi / (MODE / LENGTH)**2 * np.sqrt(DENSITY / RIGIDITY)


@pytest.mark.parametrize(('nodes', 'lines', 'axis'), [
    (16, 1, 1), pytest.param(32, 1, 1, marks=pytest.mark.long), (64, 1, 1),
    pytest.param(16, 4, 1, marks=pytest.mark.long), (16, 4, 0)])
def test_a_cantilever_under_its_weight(strip, within, nodes, lines, axis):
    """A strip does not come to w L^4 / (8 B): another grid would be another cloth."""
    weight = DEFLECTION * LENGTH * 8.0 * RIGIDITY / LENGTH**4
    simulation, at = strip(
        nodes, lines, axis, gravity=[0.0, 0.0, -weight / DENSITY], dt=_period() / 400.0)
    shape = -weight * at**2 * (6.0 * LENGTH**2 - 4.0 * LENGTH * at + at**2) / (24.0 * RIGIDITY)
    _bend(simulation, shape, axis)
    # After a quarter of its period it is where it would stay, were it damped.
    simulation.advance(_period() / 4.0)
    exact = weight * LENGTH**4 / (8.0 * RIGIDITY)
    within(f'{nodes} nodes, {lines} lines, deflection of the tip under weight, relative',
           abs(-_tip(simulation, axis) / exact - 1.0), 0.02)


@pytest.mark.parametrize('nodes', [16, pytest.param(32, marks=pytest.mark.long), 64])
def test_the_first_mode_of_a_cantilever(strip, within, nodes):
    """A strip swings at another frequency than that of a clamped beam."""
    simulation, at = strip(nodes, gravity=[0.0, 0.0, 0.0], dt=_period() / 400.0)
    place = MODE * at / LENGTH
    shape = np.cosh(place) - np.cos(place) - SHAPE * (np.sinh(place) - np.sin(place))
    _bend(simulation, 0.5 * DEFLECTION * LENGTH * shape)
    tips = [_tip(simulation)]
    while tips[-1] > 0.0:
        simulation.step(10)
        tips.append(_tip(simulation))
    crossed = simulation.time - 10 * simulation.dt * tips[-1] / (tips[-1] - tips[-2])
    within(f'{nodes} nodes, frequency of the first mode, relative',
           abs(_period() / 4.0 / crossed - 1.0), 0.02)


def _check_damping(strip, within, nodes):
    """Check the swing after a period against that of a damped oscillator from rest."""
    ratio = 0.05
    omega = 2.0 * np.pi / _period()
    simulation, at = strip(nodes, gravity=[0.0, 0.0, 0.0], dt=_period() / 400.0, **{
        'bending.damping': 2.0 * ratio / omega})
    place = MODE * at / LENGTH
    shape = np.cosh(place) - np.cos(place) - SHAPE * (np.sinh(place) - np.sin(place))
    _bend(simulation, 0.5 * DEFLECTION * LENGTH * shape)
    begin = _tip(simulation)
    damped = omega * np.sqrt(1.0 - ratio**2)
    simulation.advance(2.0 * np.pi / damped)
    exact = np.exp(-ratio * omega * 2.0 * np.pi / damped)
    within(f'{nodes} nodes, swing after a period over the first, relative to exp(-z w t)',
           abs(_tip(simulation) / begin / exact - 1.0), 0.02)


@pytest.mark.parametrize('nodes', [16, pytest.param(32, marks=pytest.mark.long)])
def test_damping_of_the_first_mode(strip, within, nodes):
    """A bent strip would come to rest at another rate on another grid, or swing for ever."""
    _check_damping(strip, within, nodes)


# The explicit modes need millions of substeps there: their rounding adds up, numerics.md.
@pytest.mark.long
@pytest.mark.parametrize('any_mode', ['constraint'], indirect=True)
def test_damping_on_a_fine_grid(strip, within):
    """A finer grid would come to rest at another rate."""
    _check_damping(strip, within, 64)


def test_momentum(simulate, within, any_mode):
    """What bending gives to one node it does not take from others."""
    simulation = simulate({
        'mode': any_mode, 'rows': 12, 'cols': 9, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'start.z': 0.0, 'bending.rigidity': [0.02, 0.05], 'bending.damping': 2e-4, 'dt': 2e-4,
        **SPRINGS})
    random = np.random.default_rng(3)
    rest = simulation.scene.rest_positions()
    simulation.set_state(
        (rest + random.standard_normal(rest.shape) / 150.0).astype(np.float32),
        0.1 * random.standard_normal(rest.shape).astype(np.float32))
    before = momenta(simulation.snapshot())
    simulation.step(50)
    after = momenta(simulation.snapshot())
    within('linear momentum, change over sum of |v|',
           np.abs(after[0] - before[0]).max() / before[2], 1e-6)
    within('angular momentum, change over sum of |x| |v|',
           np.abs(after[1] - before[1]).max() / before[3], 5e-6)


def test_a_crumpled_cloth_is_braked(simulate, within, any_mode):
    """Where lines are folded up, damping would throw the nodes instead of braking them."""
    simulation = simulate({
        'mode': any_mode, 'rows': 12, 'cols': 9, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
        'start.z': 0.0, 'bending.rigidity': 2e-3, 'bending.damping': 0.5, 'dt': 2e-3, **{
            f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}, **SPRINGS,
        'solver.tolerance': 1e-4, 'solver.max_iterations': 60})
    random = np.random.default_rng(5)
    rest = simulation.scene.rest_positions()
    # Rows lie on each other, every other one turned back: lines along columns are folded.
    folded = rest.copy()
    folded[..., 1] = 0.01 * (np.arange(12) % 2)[:, None]
    folded += random.uniform(-0.005, 0.005, rest.shape)
    simulation.set_state(
        folded.astype(np.float32), random.uniform(-1.0, 1.0, rest.shape).astype(np.float32))
    begin = simulation.snapshot()
    before, momentum = begin.kinetic_energy + begin.elastic_energy, momenta(begin)
    for _ in range(5):
        simulation.step(5)
        after = simulation.snapshot()
        within('energy over that at the start',
               (after.kinetic_energy + after.elastic_energy) / before, 1.02)
    within('angular momentum, change over sum of |x| |v|',
           np.abs(momenta(after)[1] - momentum[1]).max() / momentum[3], 1e-4)


def test_a_cylinder_stores_what_a_sheet_does(simulate, within, any_mode):
    """Energy of bending would be missing in the balance of a run."""
    bend, (warp, weft) = 0.7, (0.02, 0.05)
    simulation = simulate({
        'mode': any_mode, 'rows': 9, 'cols': 12, 'width': 0.8, 'height': 0.5, 'start.z': 0.0,
        'bending.rigidity': [warp, weft], 'constraint.hard': [],
        **{f'{name}.{family}': 0.0 for name in ('stiffness', 'damping')
           for family in ('structural', 'shear', 'bend')}})
    rest = simulation.scene.rest_positions()
    cell = np.prod(simulation.scene.spacing)
    # Inner nodes of each line, each in a cell of its own.
    for axis, rigidity, count in ((0, warp, 9 * 10), (1, weft, 7 * 12)):
        moved = rest.copy()
        moved[..., 2] += 0.5 * bend * rest[..., axis]**2
        simulation.set_state(
            moved.astype(np.float32), np.zeros(rest.shape, dtype=np.float32))
        exact = 0.5 * rigidity * bend**2 * cell * count
        within('energy of a bent sheet, relative',
               abs(simulation.snapshot().elastic_energy / exact - 1.0), 1e-4)


def test_a_mirrored_cloth_bends_alike(simulate, within, any_mode):
    """Left and right would be bent by other rounding: a symmetric scene would lean to one side."""
    simulation = simulate({
        'mode': any_mode, 'rows': 16, 'cols': 16, 'dt': 0.001, 'bending.rigidity': 1e-3,
        'solver.tolerance': 1e-3})
    simulation.advance(0.1)
    positions = simulation.snapshot().positions.astype(float)
    mirrored = positions[:, ::-1] * [-1.0, 1.0, 1.0]
    within('mirror symmetry at 0.1 s [m]', np.abs(positions - mirrored).max(), 2e-5)
