# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What advances and observes a state by one mode, and the engines of a cloth."""

from collections.abc import Iterator
import json
import os
from pathlib import Path
import subprocess
import sys
import threading
from types import FrameType

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS

_SCENE = {**SPRINGS, 'rows': 12, 'cols': 10, 'dt': 0.01}


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    """Make a cloth of springs."""
    simulation = Simulation(Scene(_SCENE))
    simulation.step(1)
    simulation.snapshot()
    yield simulation
    simulation.close()


def run_beside(simulation: Simulation, preparation: Preparation) -> int:
    """Advance the cloth while another thread prepares a mode; return the steps made."""
    thread = threading.Thread(target=preparation.run)
    first = simulation.steps
    thread.start()
    while thread.is_alive():
        simulation.step(1)
        simulation.measure()
    thread.join()
    if preparation.error:
        raise preparation.error
    return simulation.steps - first


@pytest.mark.parametrize('mode', modes.AVAILABLE)
def test_the_cloth_goes_on_while_a_mode_is_prepared(mode: str):
    """A node would stand still for as long as the compiler takes, or go wrong by it."""
    other = 'adaptive' if mode == 'mass_spring' else 'mass_spring'
    simulations = [Simulation(Scene({**SPRINGS, **_SCENE, 'mode': other})) for _ in range(2)]
    prepared, plain = simulations
    preparation = prepared.engines.preparation(mode)
    made = run_beside(prepared, preparation)
    assert made > 0 and preparation.compiled > 0
    plain.step(made)
    assert prepared.take_over(preparation) == plain.set_mode(mode) != mode
    assert prepared.mode == mode
    for each in simulations:
        each.push((0.0, 0.0, 0.4), duration=0.1, region='sphere', radius=2.0)
        each.step(5)
    assert prepared.snapshot().state_sha256 == plain.snapshot().state_sha256
    for each in simulations:
        each.close()


@pytest.mark.parametrize('mode', modes.AVAILABLE)
def test_nothing_is_left_to_compile(mode: str):
    """The first steps, pushes, pins and looks in the new mode would wait for the compiler."""
    simulation = Simulation(Scene(_SCENE), compiles=False)
    assert not simulation.is_ready and simulation.mode == 'mass_spring'
    preparation = simulation.engines.preparation(mode)
    thread = threading.Thread(target=preparation.run)
    thread.start()
    thread.join()
    simulation.take_over(preparation)
    with take_inventory() as inventory:
        simulation.step(3)
        simulation.push((0.0, 0.0, 5.0), duration=0.1)
        simulation.push((0.0, 0.0, 1.0), duration=0.1, region='sphere', radius=2.0)
        simulation.step(20)
        for corner in ((0, 0), (0, 9)):
            simulation.release(*corner)
        simulation.step(5)
        simulation.snapshot(tension=True)
        simulation.measure()
    assert simulation.is_ready and simulation.steps == 28
    assert [program.name for program in inventory.programs] == []
    simulation.close()


@pytest.mark.parametrize('scheme', ('mass_spring', 'constraint', 'adaptive', 'paper'))
def test_a_frame_converts_no_argument_in_python(scheme: str):
    """Ctrl-C would now and then be an ArgumentError of ctypes, which no program expects."""
    values = {'adaptive.scheme': 'paper', 'mode': 'adaptive'} if scheme == 'paper' else {
        'mode': scheme, 'adaptive.threshold': 0.005}
    converted = []

    def note(frame: FrameType, event: str, _argument: object) -> None:
        if event == 'call' and frame.f_code.co_name == 'from_param':
            converted.append(frame.f_back.f_code.co_name)

    with Simulation(Scene({**_SCENE, **values})) as simulation:
        for profile in (None, note):
            sys.setprofile(profile)
            try:
                simulation.step(2)
                simulation.snapshot(tension=True)
            finally:
                sys.setprofile(None)
    assert converted == []


def test_a_mode_can_be_taken_back_and_forth(simulation: Simulation):
    """A context would be lost, or a mode be compiled again, on the second switch."""
    preparation = simulation.engines.preparation('adaptive')
    run_beside(simulation, preparation)
    simulation.take_over(preparation)
    for mode in ('mass_spring', 'adaptive', 'mass_spring'):
        with take_inventory() as inventory:
            simulation.set_mode(mode)
            simulation.step(2)
            assert simulation.snapshot().finite and simulation.mode == mode
        assert not inventory.programs


def test_a_preparation_can_be_cancelled(simulation: Simulation):
    """A node that is stopped would go on compiling for seconds."""
    preparation = simulation.engines.preparation('constraint')
    preparation.cancel()
    run_beside(simulation, preparation)
    assert preparation.engine is None and preparation.error is None
    assert not simulation.engines.has('constraint')
    again = simulation.engines.preparation('constraint')
    run_beside(simulation, again)
    simulation.take_over(again)
    simulation.step(1)


def test_what_cannot_be_is_refused_before_it_is_prepared():
    """A refusal would come seconds after the request, from another thread."""
    simulation = Simulation(
        Scene({**SPRINGS, **_SCENE, 'mode': 'constraint', 'dt': 0.1, 'auto_substeps': False}))
    with pytest.raises(ClothSimError, match='stability limit'):
        simulation.engines.preparation('mass_spring')
    with pytest.raises(ClothSimError, match='there is no mode'):
        simulation.engines.preparation('rigid')
    simulation.close()


def test_an_error_is_kept_for_the_thread_that_waits(simulation: Simulation):
    """The request would never be answered."""
    def fail(context):
        raise ClothSimError('no device for it')
    preparation = Preparation('adaptive', fail, simulation._first_context)
    thread = threading.Thread(target=preparation.run)
    thread.start()
    thread.join()
    assert str(preparation.error) == 'no device for it'
    simulation.step(1)


# What the engines of a cloth leave behind on the device.

# Names that GL gives to shaders and programs are the least that are free.
_NAMES = range(1, 2000)


@pytest.mark.parametrize('scheme', ('constraint', 'paper'))
def test_programs_are_shared_and_buffers_released(scheme):
    """A long process that makes one cloth after another would fill up with compiled shaders."""
    context = Context(single_thread=True)
    try:
        counts = []
        for _ in range(2):
            with take_inventory() as inventory:
                run = Simulation(Scene({
                    **SPRINGS, 'rows': 5, 'cols': 6, 'pins': ['none'], 'adaptive.scheme': scheme,
                    'air.density': 1.2}), context=context)
                for mode in AVAILABLE:
                    run.set_mode(mode)
                    run.engines.compile_all()
                    run.snapshot()
                run.close()
            assert inventory.buffers == []
            counts.append(_programs())
        assert counts[0] >= len(AVAILABLE)
        assert counts[1] == counts[0]
    finally:
        context.close()


def _programs() -> int:
    """Return how many programs the device has."""
    return sum(bool(GL.glIsProgram(name)) for name in _NAMES)


_LAYERS = {
    'self_contact.enabled': True, 'start.z': 0.0, 'colliders.names': ['floor'],
    'colliders.floor.shape': 'plane', 'colliders.floor.position': [0.0, 0.0, -0.01]}

# Each part in a process of its own, forked before there is a device: it need not import again.
# What the folder of the cache has after each is printed.
_IN_PROCESSES = """
import json
import os
from pathlib import Path
import sys
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

def use(mode, values, part):
    with Simulation(Scene({'rows': 12, 'cols': 12, 'mode': mode, **values})) as run:
        run.warm_up()
        if part == 'runs':
            for push in ('none', 'all', 'sphere'):
                if push != 'none':
                    run.push((0.0, 0.0, 0.1), duration=0.02, region=push, radius=5.0)
                run.step(3)
                run.snapshot(tension=True, pin_forces=True)
            # Beyond what a limit allows, and hard edges.
            run.set_state(1.2 * run.positions(), 0.0 * run.velocities())
            run.step(3)
            run.snapshot(tension=True, pin_forces=True)
            if run.scene['self_contact.enabled']:
                # Two layers, a thickness apart, pressed together.
                flat = run.scene.start_positions()
                upper = flat[::-1][6:] + (0.0, 0.0, run.scene['self_contact.thickness'])
                run.set_state(np.concatenate([flat[:6], upper]), np.concatenate([
                    0.0 * flat[:6], 0.0 * upper - (0.0, 0.0, 1.0)]))
                run.step(3)
                assert run.snapshot(tension=True, pin_forces=True).self_contacts > 0

kept = []
for part in sys.argv[3:]:
    child = os.fork()
    if not child:
        use(sys.argv[1], json.loads(sys.argv[2]), part)
        sys.exit()
    assert os.waitpid(child, 0)[1] == 0, part
    kept.append({str(path): path.stat().st_size
                 for path in Path(os.environ['MESA_SHADER_CACHE_DIR']).rglob('*')
                 if path.is_file()})
print(json.dumps(kept))
"""


@pytest.fixture(scope='module')
def shader_cache(tmp_path_factory) -> Path:
    """Return a folder for what a driver has compiled."""
    return tmp_path_factory.mktemp('shader_cache')


@pytest.mark.parametrize(('mode', 'values'), [
    ('mass_spring', {}), ('mass_spring', {'material.preset': 'none'}), ('constraint', {}),
    ('adaptive', {}), ('mass_spring', _LAYERS), ('constraint', _LAYERS)])
def test_the_driver_has_nothing_left_to_compile(context, shader_cache, mode, values):
    """A first step, push on a region or limit in force would keep a node busy for seconds."""
    if not context.is_software or 'Mesa' not in context.version:
        pytest.skip('Mesa alone shows what it compiles, by what its cache gets')
    environment = {
        **os.environ, 'MESA_SHADER_CACHE_DIR': str(shader_cache), 'LP_NUM_THREADS': '0',
        # What is run for a moment need not be optimised.
        'GALLIVM_PERF': 'nopt'}
    environment.pop('MESA_SHADER_CACHE_DISABLE', None)
    # The driver writes its cache in the background, and now and then ends before all is written.
    done = subprocess.run(
        [sys.executable, '-c', _IN_PROCESSES, mode, json.dumps(values),
         'is prepared', 'is prepared', 'runs'],
        check=True, env=environment, stdout=subprocess.PIPE)
    kept = json.loads(done.stdout)
    assert kept[1], 'the driver keeps compiled programs'
    assert kept[2] == kept[1]
