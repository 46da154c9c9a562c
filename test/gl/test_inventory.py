# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is compiled, allocated and run is counted while somebody asks."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS


@pytest.fixture
def context():
    """Return a context."""
    context = Context(single_thread=True)
    yield context
    context.close()


def test_buffers_are_listed_until_they_are_given_back(context):
    """Memory would be counted that is not there, or not be counted."""
    with take_inventory() as inventory:
        kept, gone = Buffer(64), Buffer(1000)
        gone.delete()
    Buffer(16).delete()
    assert inventory.buffers == [kept]
    assert inventory.buffer_bytes == 64
    kept.delete()


def test_runs_of_a_step_are_counted(context):
    """A pass would seem to cost nothing, or to be run more often than it is."""
    with take_inventory() as inventory:
        run = Simulation(
            Scene({
                **SPRINGS, 'rows': 6, 'cols': 6, 'auto_substeps': False, 'substeps': 3,
                'dt': 1e-3}),
            context=context, records_forces=False)
        run.step(2)
    counts = dict(zip((program.name for program in inventory.programs), inventory.dispatches()))
    assert counts == {'mass_spring_step.comp': 6, 'bounds_check.comp': 1}
    run.close()


def test_a_shader_tells_the_choices_that_it_reads():
    """A choice would seem to be compiled in that the shader never looks at."""
    source = ShaderSource('bounds_check.comp', {
        'ROWS': 4, 'COLS': 4, 'PITCH': 8, 'HAS_BEND': 1, 'MOST_MAGNITUDE': '1e12'})
    assert 'HAS_BEND' not in source.used_defines
    assert 'MOST_MAGNITUDE' in source.used_defines


def test_nothing_is_noted_without_an_inventory(context):
    """Programs would be kept for ever."""
    with take_inventory() as inventory:
        pass
    scene = Scene({**SPRINGS, 'rows': 4, 'cols': 4})
    Simulation(scene, context=context).close()
    assert inventory.programs == [] and inventory.buffers == []
