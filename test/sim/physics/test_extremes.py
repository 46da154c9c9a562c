# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Extreme scenes in every mode: each runs finite, is refused, or stops at the last finite state.

The table of docs/reliability.md is what ``-rP`` prints, one line a scene and mode.
"""

from collections.abc import Callable
from collections.abc import Iterator
from itertools import product

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Measures
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
import pytest

FAMILIES = ('structural', 'shear', 'bend')
_STEPS = 20
# Of what the adaptive mode takes thousands of substeps for.
_FEW = 3
# What a way out begins with.
WAYS_OUT = ('set ', 'take ', 'push ', 'stretch ', 'give ', 'use ', 'go on ')


def _of_all(name: str, value: float) -> dict[str, float]:
    return {f'{name}.{family}': value for family in FAMILIES}


# Scenes that have to run in every mode.
RUNNING = {
    '2 x 2': {'rows': 2, 'cols': 2},
    '1 x 2': {'rows': 1, 'cols': 2, 'pins': ['top_left']},
    '2 x 1000': {'rows': 2, 'cols': 1000},
    '1000 x 2': {'rows': 1000, 'cols': 2},
    'all pinned': {'pins': ['all']},
    'none pinned': {'pins': ['none']},
    'chain between two pins at rest distance': {
        'rows': 1, 'cols': 12, **_of_all('stiffness', 1e4)},
    'zero gravity': {'gravity': [0.0, 0.0, 0.0]},
    'stiffness 1e-3': _of_all('stiffness', 1e-3),
    'stiffness 1e6': _of_all('stiffness', 1e6),
    'mass 1e-6': {'node_mass': 1e-6},
    'mass 1e3': {'node_mass': 1e3},
    'dt 1e-6': {'dt': 1e-6},
    'dt 0.1': {'dt': 0.1},
    'damping 0': _of_all('damping', 0.0),
    'jitter 0.5': {'start.jitter': 0.5},
    'threshold 0.5': {'adaptive.threshold': 0.5},
    'threshold 0.005': {'adaptive.threshold': 0.005},
    'side 100 km': {'width': 1e5, 'height': 1e5},
}

# Corners of stiffness, mass of a node and dt, undamped: they run, or take too many substeps.
CORNERS = {
    f'k {stiffness:g}, m {mass:g}, dt {dt:g}': {
        **_of_all('stiffness', stiffness), **_of_all('damping', 0.0), 'node_mass': mass, 'dt': dt}
    for stiffness, mass, dt in product((1e-3, 1e6), (1e-6, 1e3), (1e-6, 0.1))}
GRID = {
    f'k {stiffness:g}, m {mass:g}, dt {dt:g}': {
        **_of_all('stiffness', stiffness), **_of_all('damping', 0.0), 'node_mass': mass, 'dt': dt}
    for stiffness, mass, dt in product(
        (1e-3, 1.0, 1e3, 1e6), (1e-6, 1e-3, 1.0, 1e3), (1e-6, 1e-4, 0.01, 0.1))}

# Scenes that may be too much.
VIOLENT = {
    'damping 1e6': _of_all('damping', 1e6),
    'gravity 1e4': {'gravity': [0.0, 0.0, -1e4]},
    'side 0.1 mm': {'width': 1e-4, 'height': 1e-4},
    'no springs': {**_of_all('stiffness', 0.0), **_of_all('damping', 0.0)},
    '8000 x 8000': {'rows': 8000, 'cols': 8000},
}

PUSHES = {
    'push 1e3 N': {'force': (1e3, 0.0, 1e3), 'duration': 0.1},
    'push 1e9 N': {'force': (1e9, 0.0, 1e9), 'duration': 0.1},
    'push 1e30 N': {'force': (1e30, 0.0, 1e30), 'duration': 0.1},
    'push 1e30 N for 1e-9 s': {'force': (1e30, 0.0, 0.0), 'duration': 1e-9},
    'push 1e-30 N': {'force': (1e-30, 0.0, 0.0), 'duration': 1.0},
    'push 1e6 N on four nodes': {
        'force': (0.0, 0.0, 1e6), 'duration': 0.1, 'region': 'sphere', 'center': (0.0, 0.0, 1.0),
        'radius': 0.15},
}

STARTS = {
    'scrambled': lambda rest, random: random.uniform(-0.5, 0.5, rest.shape),
    'all in one point': lambda rest, random: np.zeros_like(rest),
    'each off by 0.7 of the spacing': lambda rest, random: rest + random.uniform(
        -0.1, 0.1, rest.shape),
    'all on one line': lambda rest, random: rest * (1.0, 0.0, 0.0),
    'inside out': lambda rest, random: rest[:, ::-1],
    'stretched 1e5 times': lambda rest, random: 1e5 * rest,
    'scrambled over 1e11 m': lambda rest, random: random.uniform(-1e11, 1e11, rest.shape),
}
SPEEDS = {'speeds of 1e3 m/s': 1e3, 'speeds of 1e9 m/s': 1e9}


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Return one context for all scenes."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.fixture(params=modes.AVAILABLE)
def mode(request: pytest.FixtureRequest) -> str:
    """Return each mode there is."""
    return request.param


@pytest.fixture
def outcome(
        request: pytest.FixtureRequest, context: Context, mode: str) -> Callable[..., str]:
    """
    Return a function that runs a scene, checks and prints what came out, and returns it.

    It takes the scene's name and values, what to do before the first step, the steps to make, and
    whether there must not be more energy at the end than at the start.
    """

    def run(
            name: str, values: dict, prepare: Callable[[Simulation], None] | None = None,
            steps: int = _STEPS, *, conserves: bool = False) -> str:
        scene = {'rows': 8, 'cols': 8, 'mode': mode, **values}
        try:
            simulation = Simulation(Scene(scene), context=context)
        except (ClothSimError, DeviceError) as error:
            _check_message(str(error))
            return _tell(name, mode, 'refused', str(error))
        request.addfinalizer(simulation.close)
        try:
            if prepare is not None:
                prepare(simulation)
            begin = simulation.measure()
            for _ in range(steps):
                simulation.step()
        except NonFiniteStateError as error:
            _check_message(str(error))
            _check_numbers(simulation)
            return _tell(name, mode, 'stops', str(error))
        seen = _check_numbers(simulation)
        if conserves:
            _check_energy(simulation, begin, seen)
        return _tell(
            name, mode, 'runs',
            f'strain {seen.max_strain:.2g}, kinetic energy {seen.kinetic_energy:.2g} J')

    return run


def _check_message(message: str) -> None:
    rule, _, way_out = message.rpartition(': ')
    assert any(character.isdigit() for character in rule), message
    assert way_out.startswith(WAYS_OUT), message
    assert '\n' not in message


def _check_numbers(simulation: Simulation) -> Snapshot:
    seen = simulation.snapshot()
    assert seen.finite
    for name in ('kinetic_energy', 'elastic_energy', 'gravitational_energy', 'max_strain'):
        assert np.isfinite(getattr(seen, name)), name
    for name in ('positions', 'velocities', 'normals', 'strain'):
        assert np.isfinite(getattr(seen, name)).all(), name
    np.testing.assert_allclose(np.linalg.norm(seen.normals, axis=-1), 1.0, atol=1e-4)
    assert seen.time == simulation.steps * simulation.dt
    return seen


def _check_energy(simulation: Simulation, begin: Measures, end: Measures) -> None:
    """Fail where there is more energy than at the start, but for what scheme and float32 add."""
    scene = simulation.scene
    stiffest = max(scene.stiffness(family) for family in FAMILIES)
    rounding = stiffest * 12 * scene.node_count * (2e-7 * np.abs(scene.rest_positions()).max())**2
    # Without damping, what each substep rounds adds up like a random walk.
    rounding *= 1.0 + 0.01 * simulation.steps * simulation.substeps
    rounding += 1e-6 * abs(begin.gravitational_energy)
    energies = [
        np.array([seen.kinetic_energy, seen.elastic_energy, seen.gravitational_energy])
        for seen in (begin, end)]
    if simulation.mode == 'constraint':
        # Hard edges have no elastic energy. What float32 rounds of a length, a substep takes back.
        for energy in energies:
            energy[1] = 0.0
        speed = 2e-7 * np.abs(scene.rest_positions()).max() * simulation.substeps / scene['dt']
        rounding += 0.5 * scene.node_mass * scene.node_count * speed**2
    most = max(energy[:2].sum() for energy in energies)
    assert energies[1].sum() <= energies[0].sum() + 0.1 * most + rounding


def _tell(name: str, mode: str, what: str, detail: str) -> str:
    print(f'| {name} | {mode} | {what} | {detail} |')
    return what


@pytest.mark.parametrize('name', RUNNING)
def test_runs(outcome, name):
    """A scene that is asked for could not be run."""
    values = RUNNING[name]
    steps = _FEW if '1000' in name else _STEPS
    # Hard edges that begin away from their length bring energy with them.
    assert outcome(name, values, steps=steps, conserves=name != 'jitter 0.5') == 'runs'


@pytest.mark.parametrize('name', CORNERS)
def test_corners_run_or_are_refused(outcome, name):
    """A cloth would turn into NaN, or a step never end."""
    assert outcome(name, CORNERS[name], steps=2, conserves=True) in ('runs', 'refused')


@pytest.mark.long
@pytest.mark.parametrize('name', GRID)
def test_the_grid_runs_or_is_refused(outcome, name):
    """The same, between the corners."""
    assert outcome(name, GRID[name], steps=3, conserves=True) in ('runs', 'refused')


@pytest.mark.parametrize('name', VIOLENT)
def test_a_violent_scene_is_never_nan(outcome, name):
    """A cloth would turn into NaN without a word."""
    assert outcome(name, VIOLENT[name], conserves=True)


@pytest.mark.parametrize('name', PUSHES)
def test_a_violent_push_is_never_nan(outcome, name):
    """A push would turn the cloth into NaN, or do nothing, without a word."""
    what = outcome(name, {}, lambda simulation: simulation.push(**PUSHES[name]), _FEW)
    assert what == 'stops' or '1e30' not in name


@pytest.mark.parametrize('name', STARTS)
def test_a_wild_start_is_never_nan(outcome, name):
    """Nodes in one place or far apart would turn the cloth into NaN without a word."""

    def prepare(simulation):
        rest = simulation.scene.rest_positions()
        positions = STARTS[name](rest, np.random.default_rng(3))
        simulation.set_state(positions, np.zeros_like(positions))

    assert outcome(name, {}, prepare, _FEW)


def test_a_scrambled_cloth_comes_back_to_its_limit(context, request):
    """Edges that are brought back to their limit throw the nodes about for ever."""
    simulation = Simulation(Scene({'rows': 8, 'cols': 8, 'mode': 'adaptive'}), context=context)
    request.addfinalizer(simulation.close)
    positions = STARTS['scrambled'](
        simulation.scene.rest_positions(), np.random.default_rng(3))
    simulation.set_state(positions, np.zeros_like(positions))
    begin = simulation.measure()
    strains, energies = [], []
    for _ in range(30):
        simulation.advance(0.1)
        now = simulation.measure()
        strains.append(now.max_strain)
        energies.append(now.kinetic_energy / begin.elastic_energy)
    print(f'measured strain {begin.max_strain:.2g}, then {strains[0]:.3g} to {strains[-1]:.3g}; '
          f'kinetic energy over the elastic one at the start {energies[0]:.2g} to '
          f'{energies[-1]:.2g}')
    assert strains[-1] < 0.12
    assert energies[-1] < 0.01


@pytest.mark.parametrize('name', SPEEDS)
def test_a_fast_start_is_never_nan(outcome, name):
    """Nodes that fly apart would turn the cloth into NaN without a word."""

    def prepare(simulation):
        positions = simulation.snapshot().positions
        random = np.random.default_rng(3)
        simulation.set_state(
            positions, random.uniform(-SPEEDS[name], SPEEDS[name], positions.shape))

    assert outcome(name, {}, prepare, _FEW)


@pytest.mark.long
@pytest.mark.parametrize('name', ['falling', 'scrambled'])
def test_a_million_nodes(outcome, name):
    """A large cloth would be lost where a small one is not."""

    def scramble(simulation):
        positions = simulation.scene.rest_positions()
        positions += np.random.default_rng(3).uniform(-5e-4, 5e-4, positions.shape)
        simulation.set_state(positions, np.zeros_like(positions))

    values = {'rows': 1024, 'cols': 1024, 'dt': 1e-5, **_of_all('damping', 1e-5)}
    what = outcome(
        f'1024 x 1024, {name}', values, scramble if name == 'scrambled' else None, steps=2)
    assert what == 'runs' or name == 'scrambled'
