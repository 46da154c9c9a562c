# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What the physics tests share: how a scene is run, and how a figure is held to its limit.

A ground truth is written once. It runs for each mode it holds in and each way the shaders have
of doing it; a new mode joins by its name in the lists below.
"""

from collections.abc import Callable
from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS

# Modes whose motion is that of the springs as long as none of them is at its limit.
SPRING_MODES = ('mass_spring', 'adaptive')

# All modes: for what holds whatever the edges do.
ALL_MODES = (*SPRING_MODES, 'constraint')

# Those in which a spring may stretch without a limit.
UNLIMITED_MODES = ('mass_spring',)

# Scenes that the forces of a cloth are tested in, by what each has to show. Every mode is here.
FORCE_SCENES = {
    'mass_spring': {'mode': 'mass_spring'},
    'adaptive within its limit': {'mode': 'adaptive'},
    'adaptive at its limit': {
        'mode': 'adaptive', 'adaptive.threshold': 0.02, 'solver.tolerance': 1e-4},
    'constraint': {'mode': 'constraint', 'solver.tolerance': 1e-4},
}

LAYOUTS = ('fused', 'paper')

# What mode adaptive does below its limit, and takes longer for than the modes beside it.
AS_SPRINGS = frozenset((
    'test_ratio_of_tensions_at_the_onset_of_slip', 'test_slip_angle',
    'test_a_cloth_larger_than_one_look', 'test_pins_hold_wind_and_weight',
    'test_a_shaken_towel_is_held_up_to_the_limit', 'test_rest_shape_is_an_equilibrium',
    'test_energy_stays_and_its_error_follows_dt', 'test_hanging_strip', 'test_dispersion',
    'test_the_account_of_energy_closes', 'test_rounding_grows_as_it_does_in_any_cloth',
    'test_damping_of_the_first_mode'))


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """
    Have what another test shows as well wait for --long.

    Layout paper is that of the passes over springs, which mode constraint has not: it only reads
    storage then, one node per invocation, as in test_constraint_against_reference.py. Cloths in
    air of 64 x 64 nodes run in mode mass_spring, and those of 16 x 16 in the others too. Below its
    limit mode adaptive makes the steps of mass_spring to the bit, which test_adaptive.py holds it
    to: AS_SPRINGS are slow tests without a solve in it, of which faster variants stay.
    """
    for item in items:
        values = item.callspec.params if hasattr(item, 'callspec') else {}
        mode = values.get('any_mode', values.get('mode'))
        is_paper = (mode, values.get('layout')) == ('constraint', 'paper')
        is_round = (
            mode in ('adaptive', 'constraint')
            and item.originalname == 'test_a_cloth_drapes_over_a_body'
            and values['body']['shape'] != 'box')
        is_calm = mode == 'adaptive' and item.originalname in AS_SPRINGS
        is_fine = mode in ('adaptive', 'constraint') and values.get('side') == 64
        if is_paper or is_fine or is_calm or is_round:
            item.add_marker(pytest.mark.long)


@pytest.fixture(scope='session', params=SPRING_MODES)
def mode(request: pytest.FixtureRequest) -> str:
    """Return each mode that moves as its springs do."""
    return request.param


@pytest.fixture(scope='session', params=ALL_MODES)
def any_mode(request: pytest.FixtureRequest) -> str:
    """Return each mode."""
    return request.param


@pytest.fixture(scope='session', params=UNLIMITED_MODES)
def unlimited_mode(request: pytest.FixtureRequest) -> str:
    """Return each mode that moves as its springs do, however far they stretch."""
    return request.param


@pytest.fixture(scope='session', params=FORCE_SCENES.values(), ids=FORCE_SCENES)
def force_scene(request: pytest.FixtureRequest) -> dict:
    """Return the values of each scene that forces are tested in."""
    return request.param


@pytest.fixture(scope='session')
def tested_modes() -> frozenset[str]:
    """Return all modes these tests run in."""
    return frozenset(ALL_MODES)


@pytest.fixture(scope='session', params=LAYOUTS)
def layout(request: pytest.FixtureRequest) -> str:
    """Return each way the passes are laid out."""
    return request.param


@pytest.fixture
def simulate(context: Context) -> Iterator[Callable[..., Simulation]]:
    """
    Return a function from scene values to a simulation, which ends with the test.

    The limit of mode adaptive is put where the springs of most tests don't come to it.
    """
    opened = []

    def start(values: dict, **options) -> Simulation:
        simulation = Simulation(
            Scene({**SPRINGS, 'adaptive.threshold': 0.5, **values}), context=context, **options)
        opened.append(simulation)
        return simulation

    yield start
    for simulation in opened:
        simulation.close()


@pytest.fixture
def within() -> Callable[[str, float, float], None]:
    """Return a function that prints a figure and fails where it is above its limit."""

    def check(what: str, value: float, limit: float) -> None:
        print(f'measured {value:.1e} of {limit:g} allowed: {what}')
        assert value <= limit, what

    return check
