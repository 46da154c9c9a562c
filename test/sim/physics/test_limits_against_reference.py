# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Scheme whole of the adaptive mode against the float64 reference, which solves directly.

Both begin with edges near their limit, so that the device takes the implicit step from the first
substep on: what it does far from a limit is in test_against_reference.py, and what it does for the
edges at their limit alone is in test/sim/limits.
"""

from contextlib import closing

from cloth_sim_ros.reference.edge_law import limited_law
from cloth_sim_ros.reference.explicit_cloth import PaperAdaptiveReference
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from edge_places import edge_places
from hypothesis import assume
from hypothesis import given
from hypothesis import settings
from hypothesis import strategies
import numpy as np
import pytest

SOFT = {'stiffness.structural': 2.0, 'stiffness.shear': 2.0}
FORMS = {
    'plain': {},
    'without shear': {'stiffness.shear': 0.0, 'damping.shear': 0.0},
    'oblong cells': {'width': 2.6},
    'damped': {'damping.structural': 0.3, 'damping.shear': 0.1},
    'bend springs': {'stiffness.bend': 10.0, 'damping.bend': 0.01},
    'stiff': {'stiffness.structural': 1000.0, 'stiffness.shear': 500.0, 'substeps': 5},
    'one solve': {'constraint.newton_iterations': 1},
    'three solves': {'constraint.newton_iterations': 3},
    'harder': {'constraint.strain': 0.004},
    'wide limit': {'adaptive.threshold': 0.3},
    'three substeps': {'substeps': 3},
    'by one corner': {'pins': ['top_left']},
    'a strip': {'rows': 12, 'cols': 2, 'width': 0.1, 'pins': ['top_edge']},
}
SCENE = {
    'mode': 'adaptive', 'adaptive.scheme': 'whole', 'rows': 7, 'cols': 9, 'width': 1.3,
    'dt': 0.005, 'start.pose': 'hanging',
    'pins': ['top_left', 'top_right'], 'adaptive.threshold': 0.02, **SOFT, 'stiffness.bend': 0.0,
    'damping.bend': 0.0, 'solver.tolerance': 2e-6, 'solver.max_iterations': 400,
    'auto_substeps': False, 'pushes.start': [0.0, 0.01], 'pushes.duration': [0.03, 0.05],
    'pushes.force': [0.2, 0.0, 3.0, 0.0, 1.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.35]}
# Strain of all edges at the start, over the limit [1].
STRETCHED, PRESSED = 0.97, -0.97


def start_near_limit(simulation: Simulation, strain: float) -> ImplicitCloth:
    """
    Stretch all edges alike, give random velocities, and return the reference with the same.

    :param strain: of all edges, over the limit
    """
    scene = simulation.scene
    positions = (
        (1.0 + strain * scene['adaptive.threshold']) * scene.start_positions()
    ).astype(np.float32)
    velocities = np.random.default_rng(3).normal(0.0, 0.1, positions.shape).astype(np.float32)
    velocities[scene.pinned_nodes()] = 0.0
    simulation.set_state(positions, velocities)
    return _cloth_at(ImplicitCloth, scene, positions, velocities)


def _cloth_at(kind, scene, positions, velocities):
    cloth = kind(scene, limited_law(scene))
    cloth.positions, cloth.velocities = positions.astype(float), velocities.astype(float)
    return cloth


def step_both(simulation: Simulation, oracle: ImplicitCloth, within, steps: int = 6) -> None:
    """
    Step both and hold the device to the reference, as far as float32 goes.

    A position near 1 m is rounded by 2^-25 m, an edge by twice that, over h for velocities, over E
    for tensions. The steps and the solves, which stop at 1e-6 of the change, make it some times as
    much.
    """
    sides, scene = [], simulation.scene
    rounded = 0
    for _ in range(steps):
        simulation.step()
        oracle.step()
        assert oracle.report.settled
        snapshot = simulation.snapshot()
        assert snapshot.solver_reached
        assert simulation.substeps == oracle.report.substeps
        rounded += simulation.substeps
        # Each substep was an implicit one.
        assert snapshot.solves >= simulation.substeps * scene['constraint.newton_iterations']
        sides.append(_sides(snapshot, oracle))
    # Edges come to their limits and leave them.
    assert np.count_nonzero(sides) > steps
    assert np.count_nonzero(np.diff(sides, axis=0)) > 0
    snapshot = simulation.snapshot(tension=True)
    rounding = 2.0**-24
    h = oracle.dt / simulation.substeps
    # Positions are rounded in each substep, one way or the other.
    within('positions [m]', np.abs(snapshot.positions - oracle.positions).max(),
           8.0 * rounding * np.sqrt(rounded))
    within('velocities [m/s]', np.abs(snapshot.velocities - oracle.velocities).max(),
           20.0 * rounding / h)
    found = snapshot.tension[edge_places(oracle.law.edges, scene.cols)]
    hardest = np.max(oracle.law.slope(2.0 * oracle.law.edges.rest_length))
    within('tensions [N]', np.abs(found - oracle.tension).max(), 4.0 * rounding * hardest)


def _sides(snapshot, oracle):
    """Return which limits pull, and hold the count of the device to theirs."""
    lengths = oracle.law.edges.lengths(oracle.positions.reshape(-1, 3))
    limit = oracle.scene['adaptive.threshold']
    strains = np.abs(lengths / oracle.law.edges.rest_length - 1.0)
    limited = np.isfinite(oracle.law.longest)
    # An edge this close to where its limit sets in may be on either side of that.
    least, most = (np.count_nonzero(strains[limited] > limit + doubt) for doubt in (2e-5, -2e-5))
    assert least <= snapshot.active_constraints <= most
    return oracle.law.side(lengths)


@pytest.mark.parametrize(('form', 'loads'), [
    *((form, 'texture') for form in FORMS), ('plain', 'storage'), ('bend springs', 'storage'),
    *(pytest.param(form, 'storage', marks=pytest.mark.long) for form in FORMS
      if form not in ('plain', 'bend springs'))])
def test_steps_and_tensions(simulate, within, form, loads):
    """A limit is not in force where it is, or does not pull as its law says."""
    simulation = simulate({**SCENE, **FORMS[form], 'loads': loads})
    step_both(simulation, start_near_limit(simulation, STRETCHED), within)


@pytest.mark.parametrize('form', ['without shear', 'oblong cells', 'wide limit', 'by one corner'])
def test_the_lower_limit(simulate, within, form):
    """Edges that are pressed together are not held, or are where they should be pulled."""
    simulation = simulate({**SCENE, **FORMS[form]})
    step_both(simulation, start_near_limit(simulation, PRESSED), within)


@pytest.mark.parametrize(('form', 'refine'), [
    ('plain', 1), ('damped', 1), ('bend springs', 1), ('damped', 2),
    *(pytest.param(form, 2, marks=pytest.mark.long) for form in ('plain', 'bend springs'))])
def test_substeps_are_those_of_the_reference(simulate, within, form, refine):
    """Substeps at the limit are chosen otherwise, or do not fit where their length changes."""
    simulation = simulate({
        **SCENE, **FORMS[form], 'auto_substeps': True, 'dt': 0.02, 'refine': refine})
    step_both(simulation, start_near_limit(simulation, STRETCHED), within)


def test_a_pin_that_moves(simulate, within):
    """The pull of a pin that leaves is not foreseen, so that its edges pass their limit."""
    simulation = simulate({**SCENE, 'substeps': 2})
    oracle = start_near_limit(simulation, STRETCHED)
    way = np.array([3.0, 0.0, 4.0])
    simulation.move_pin(0, 8, oracle.positions[0, 8] + way, 0.5)
    oracle.move_pin(0, 8, 0.5 * way / 5.0)
    step_both(simulation, oracle, within)


class Rounded(ImplicitCloth):
    """The reference with its state rounded to the nearest float32 before each substep."""

    def _hold(self, now, h):
        for name in ('positions', 'velocities', 'tension'):
            setattr(self, name, self._rounded(getattr(self, name)))
        return super()._hold(now, h)

    def _rounded(self, state):
        return state.astype(np.float32).astype(float)


class RoundedEitherWay(Rounded):
    """Rounded up or down at random: what a single twin strays by is chance."""

    def __init__(self, *args):
        super().__init__(*args)
        self._random = np.random.default_rng(0)

    def _rounded(self, state):
        either = (self._random.random(state.shape) - 0.5) * np.spacing(state.astype(np.float32))
        return super()._rounded(state + either)


def _numbers(low, high):
    return strategies.floats(low, high).map(lambda value: float(f'{value:.4g}'))


@strategies.composite
def scene_values(draw):
    """Draw cloths of all shapes with limits of all kinds."""
    rows, cols = draw(strategies.tuples(strategies.integers(1, 12), strategies.integers(2, 12)))
    values = {
        'mode': 'adaptive', 'adaptive.scheme': 'whole', 'material.preset': 'none',
        'rows': rows, 'cols': cols,
        'width': draw(_numbers(0.3, 3.0)),
        'height': draw(_numbers(0.3, 3.0)), 'areal_density': draw(_numbers(0.05, 1.0)),
        'start.seed': draw(strategies.integers(0, 1000)), 'dt': draw(_numbers(0.002, 0.02)),
        'start.pose': draw(strategies.sampled_from(('hanging', 'horizontal'))),
        'adaptive.threshold': draw(strategies.sampled_from((0.005, 0.02, 0.1, 0.1, 0.3, 0.5))),
        'constraint.newton_iterations': draw(strategies.sampled_from((2, 2, 3))),
        'solver.tolerance': 1e-6, 'solver.max_iterations': 400,
        'pins': draw(strategies.sampled_from((['top_left'], ['top_edge']))),
        'loads': draw(strategies.sampled_from(('texture', 'storage'))),
        'block': draw(strategies.sampled_from((1, 2)))}
    mass = Scene(values).node_mass
    for family in FAMILIES:
        stiffness = draw(_numbers(1.0, 100.0))
        values[f'stiffness.{family}'] = stiffness
        values[f'damping.{family}'] = draw(_numbers(0.0, 0.1)) * np.sqrt(stiffness * mass)
    assume(not Scene(values).pinned_nodes().all())
    if draw(strategies.booleans()):
        weight = mass * rows * cols * 9.81
        values.update({
            'pushes.start': [draw(_numbers(0.0, 0.02))], 'pushes.duration': [0.013],
            'pushes.force': [draw(_numbers(-5.0, 5.0)) * weight for _ in range(3)]})
    return values


def _hold_to_reference(values, strain):
    """
    Run the scene both ways for some steps; fail where they differ by too much.

    How far float32 may stray is measured, as in test_against_reference.py, by two twins of the
    reference that are rounded.

    :param strain: of all edges at the start, over the limit
    :return: the largest difference over what is allowed, how many edges were beyond their limit in
        all, and why the comparison ended early: 'substeps' where they came out otherwise,
        'unsolved' where one of the two says that a step is not solved, else None
    """
    scene = Scene(values)
    random = np.random.default_rng(values['start.seed'])
    start = (1.0 + strain * values['adaptive.threshold']) * scene.start_positions()
    # Fast enough to stretch edges to the limit within some hundredths of a second.
    speed = min(scene.spacing) * 5.0 * np.sqrt(values['adaptive.threshold'])
    velocities = speed * random.standard_normal(start.shape) * ~scene.pinned_nodes()[..., None]
    solves = scene['constraint.newton_iterations']
    steps, held, worst, parted = 0, 0, 0.0, None
    with closing(Simulation(scene)) as simulation:
        simulation.set_state(start, velocities)
        snapshot = simulation.snapshot()
        exact, *twins = (
            _cloth_at(kind, scene, snapshot.positions, snapshot.velocities)
            for kind in (ImplicitCloth, Rounded, RoundedEitherWay))
        while steps < 8:
            for cloth in (exact, *twins):
                cloth.step()
            noise = _difference(exact, twins, 'positions')
            # Beyond this, or with a substep more or less, rounding chooses what comes.
            if not noise < 1e-5 or any(
                    twin.report.substeps != exact.report.substeps for twin in twins):
                break
            simulation.step()
            snapshot = simulation.snapshot()
            # A count of substeps is a real number rounded up: it may part from the oracle's.
            if snapshot.substeps != exact.report.substeps:
                parted = 'substeps'
            elif not (snapshot.solver_reached and all(
                    cloth.report.settled for cloth in (exact, *twins))):
                parted = 'unsolved'
            # Far from its limit a cloth has explicit substeps again.
            if parted or snapshot.solves < solves * exact.report.substeps:
                break
            steps += 1
            held += np.count_nonzero(exact.law.side(
                exact.law.edges.lengths(exact.positions.reshape(-1, 3))))
            worst = max(worst, _miss(snapshot, exact, twins))
            assert worst <= 1.0
    assume(steps or parted == 'unsolved')
    return worst, held, parted


def _difference(exact, twins, name):
    return max(np.abs(getattr(twin, name) - getattr(exact, name)).max() for twin in twins)


def _miss(snapshot, exact, twins):
    eps = np.finfo(np.float32).eps
    last_place = eps * max(np.abs(exact.positions).max(), 0.1)
    speed_last_place = last_place * exact.report.substeps / exact.dt + (
        eps * np.abs(exact.velocities).max())
    noise = _difference(exact, twins, 'positions')
    speed_noise = _difference(exact, twins, 'velocities')
    # A twin is rounded once a step; an edge that turns over in a catch multiplies that.
    return max(
        np.abs(snapshot.positions - exact.positions).max() / (60.0 * noise + 48.0 * last_place),
        np.abs(snapshot.velocities - exact.velocities).max()
        / (60.0 * speed_noise + 48.0 * speed_last_place))


def test_random_scenes_at_the_limit(within):
    """A limit, a damping, a push or the length of a substep is not what the reference has."""
    results = []

    @settings(max_examples=6, derandomize=True, deadline=None)
    @given(values=scene_values(), strain=strategies.sampled_from((STRETCHED, PRESSED)))
    def check(values, strain):
        results.append(_hold_to_reference(values, strain))

    check()
    assert np.mean([held > 0 for _, held, _ in results]) > 0.5
    assert np.mean([parted == 'substeps' for _, _, parted in results]) < 0.2
    assert np.mean([parted == 'unsolved' for _, _, parted in results]) < 0.4
    within('random scenes at the limit against the reference',
           max(ratio for ratio, _, _ in results), 1.0)


@pytest.mark.long
@settings(max_examples=300, deadline=None)
@given(values=scene_values(), strain=strategies.sampled_from((STRETCHED, PRESSED)))
def test_many_random_scenes_at_the_limit(values, strain):
    """The same, on other scenes each time."""
    _hold_to_reference(values, strain)


@pytest.mark.parametrize('seed', range(6))
def test_the_papers_scheme_is_a_linear_solve(within, seed):
    """The sweeps of scheme paper do not come to what its linear system has."""
    scene = Scene({
        'mode': 'adaptive', 'adaptive.scheme': 'paper', 'rows': 4, 'cols': 5,
        'auto_substeps': False, 'dt': 0.002, 'start.jitter': 0.12, 'start.seed': seed,
        'pins': ['top_edge'], 'stiffness.structural': 5.0, 'stiffness.shear': 5.0})
    oracle = PaperAdaptiveReference(scene)
    held = np.count_nonzero(oracle.held())
    with closing(Simulation(scene)) as simulation:
        start = simulation.snapshot().positions.astype(float)
        oracle.positions = start
        simulation.step()
        oracle.step()
        snapshot = simulation.snapshot()
    assert held > 0
    scale = np.abs(oracle.velocities).max()
    within(f'one step of scheme paper, {held} edges beyond the limit, over the largest velocity',
           np.abs(snapshot.velocities - oracle.velocities).max() / scale, 1e-4)
