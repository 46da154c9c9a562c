# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The serial programs do the work that the shaders and the references do."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.explicit_cloth import PaperAdaptiveReference
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.paper import serial
from cloth_sim_ros.study.paper.cloths import PaperCloth
from cloth_sim_ros.study.paper.cloths import TWO_FAMILIES
from cloth_sim_ros.study.paper.contenders import PaperConstraintCloth
from cloth_sim_ros.study.paper.serial import compiled_library
from cloth_sim_ros.study.paper.serial import CompiledCloth
from cloth_sim_ros.study.paper.serial import serial_cloth
from cloth_sim_ros.study.paper.serial_model import NumpyCloth
from cloth_sim_ros.study.paper.serial_model import serial_model
from cloth_sim_ros.study.paper_figures import PAPER_ADAPTIVE
from cloth_sim_ros.study.paper_figures import PAPER_CONSTRAINT
import numpy as np
import pytest

STEPS = 10
TIGHT = 1e-6
PLAIN = {'mass_spring': {}, 'constraint': PAPER_CONSTRAINT, 'adaptive': PAPER_ADAPTIVE}
CLOTHS = (
    PaperCloth('mass_spring', 7, 9), PaperCloth('constraint', 7, 9),
    PaperCloth('constraint', 7, 9, TWO_FAMILIES), PaperCloth('adaptive', 7, 9))
HELD = tuple(cloth for cloth in CLOTHS if cloth.method != 'mass_spring')


def name_of(cloth):
    """Return a name for a case."""
    return f'{cloth.method}_{len(cloth.families)}'


def scene_of(cloth):
    """Return the scene of one step of the paper's method a dt."""
    return cloth.scene(**PLAIN[cloth.method])


def state_of(cloth):
    """Return a state in motion, in which edges of mode adaptive are beyond their limit."""
    scene = cloth.scene()
    random = np.random.default_rng(11)
    free = ~scene.pinned_nodes()[..., None]
    off = {'mass_spring': 0.02, 'constraint': 0.002, 'adaptive': 0.05}[cloth.method]
    shape = (cloth.rows, cloth.cols, 3)
    return (
        scene.rest_positions() + off * min(scene.spacing) * free * random.normal(size=shape),
        0.1 * free * random.normal(size=shape))


def moved(program, state):
    """Return the positions of ``program``, and the largest displacement of a node [m]."""
    program.set_state(*state)
    for _ in range(STEPS):
        program.step()
    positions = program.positions
    places = np.array(positions() if callable(positions) else positions, float)
    places = places.reshape(state[0].shape)
    return places, np.abs(places - state[0]).max()


def reference_of(cloth):
    """Return the float64 reference at the start of ``state_of``."""
    scene = scene_of(cloth)
    made = {
        'mass_spring': lambda: MassSpringReference(scene, 1),
        'constraint': lambda: ImplicitCloth(scene),
        'adaptive': lambda: PaperAdaptiveReference(scene)}[cloth.method]()
    made.positions, made.velocities = state_of(cloth)
    return made


@pytest.fixture(scope='module')
def context():
    """Return one context for all."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.mark.parametrize('cloth', CLOTHS, ids=name_of)
def test_numpy_is_the_reference(cloth):
    """The fallback would compute another step than the program it is compared with."""
    reference = reference_of(cloth)
    reference.step(STEPS)
    model = serial_model(scene_of(cloth), tolerance=1e-10)
    found, way = moved(NumpyCloth(model, *state_of(cloth)), state_of(cloth))
    off = np.abs(found - reference.positions).max()
    print(f'measured: {off:.1e} m of {way:.1e} m')
    assert off <= 1e-6 * way


@pytest.mark.parametrize('forms_matrix', [False, True])
@pytest.mark.parametrize('cloth', CLOTHS, ids=name_of)
def test_c_is_the_reference(cloth, forms_matrix):
    """The shaders would be compared with the speed of other work than theirs."""
    if compiled_library() is None:
        pytest.skip('there is no C compiler')
    reference = reference_of(cloth)
    reference.step(STEPS)
    model = serial_model(scene_of(cloth), tolerance=TIGHT)
    program = CompiledCloth(
        model.with_matrix() if forms_matrix else model, *state_of(cloth))
    found, way = moved(program, state_of(cloth))
    off = np.abs(found - reference.positions).max()
    print(f'measured: {off:.1e} m of {way:.1e} m, {program.held} constraints')
    assert off <= 1e-4 * way


@pytest.mark.parametrize('cloth', HELD, ids=name_of)
def test_there_are_constraints_to_solve(cloth):
    """The comparison of constraints would be one of springs alone."""
    program = NumpyCloth(serial_model(scene_of(cloth)), *state_of(cloth))
    program.step()
    assert program.iterations > 3
    if cloth.method == 'constraint':
        assert program.held == cloth.springs
    else:
        assert 5 < program.held < cloth.springs / 2


@pytest.mark.parametrize('layout', ['paper', 'fused'])
def test_springs_of_the_shaders_are_those(context, layout):
    """A ratio of speeds would be one of different forces."""
    cloth = CLOTHS[0]
    with Simulation(cloth.scene(layout=layout), context=context) as run:
        found, way = moved(run, state_of(cloth))
    expected, _ = moved(
        serial_cloth(serial_model(scene_of(cloth)), *state_of(cloth)), state_of(cloth))
    assert np.abs(found - expected).max() <= 1e-4 * way


@pytest.mark.parametrize('cloth', CLOTHS[1:3], ids=name_of)
def test_the_papers_solver_makes_the_same_steps(context, cloth):
    """The paper's shaders would be timed at an easier, or a harder, system."""
    scene, state = scene_of(cloth), state_of(cloth)
    run = PaperConstraintCloth(scene, state, TIGHT)
    found, way = moved(run, state)
    run.close()
    expected, _ = moved(serial_cloth(serial_model(scene, tolerance=TIGHT), *state), state)
    off = np.abs(found - expected).max()
    print(f'measured: {off:.1e} m of {way:.1e} m')
    assert off <= 1e-4 * way


@pytest.mark.parametrize('cloth', HELD, ids=name_of)
def test_one_step_of_the_modes_is_near(context, cloth):
    """A mode of this project would be timed at something else."""
    scene, state = scene_of(cloth), state_of(cloth)
    with Simulation(scene, context=context, check_stability=False) as run:
        run.set_state(*state)
        run.step()
        found = run.velocities() - state[1]
    program = serial_cloth(serial_model(scene, tolerance=TIGHT), *state)
    program.step()
    expected = program.velocities.reshape(state[1].shape) - state[1]
    off = np.linalg.norm(found - expected) / np.linalg.norm(expected)
    print(f'measured: {off:.1e} of the change of velocity')
    # The solver of the mode ends at a residual of 1e-2, and sweeps at a count.
    assert off <= 0.05


def test_without_a_compiler_it_is_numpy_and_says_so(monkeypatch):
    """A machine without a compiler would have no comparison, or one of an unknown program."""
    monkeypatch.setattr(serial, 'compiled_library', lambda: None)
    cloth = CLOTHS[1]
    model = serial_model(scene_of(cloth))
    assert 'NumPy' in serial_cloth(model, *state_of(cloth)).name
    with pytest.raises(ClothSimError, match='install gcc'):
        serial_cloth(model.with_matrix(), *state_of(cloth))


@pytest.mark.parametrize('compiler', ['/no/such/compiler', '/bin/false'])
def test_a_compiler_that_does_not_work_is_none(monkeypatch, compiler):
    """A broken compiler would end the whole table."""
    monkeypatch.setenv('CC', compiler)
    monkeypatch.setattr(serial, '_COMPILERS', ())
    assert serial.compiled_library.__wrapped__() is None


def test_all_families_can_be_hard():
    """The cloths of Table 10, with bend edges, would be timed without them."""
    model = serial_model(scene_of(CLOTHS[1]))
    assert set(model.edges.family) == set(FAMILIES)
    assert len(model.edges) == CLOTHS[1].springs
