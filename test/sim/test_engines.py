# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the engines of a cloth leave behind on the device."""

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest

# Names that GL gives to shaders and programs are the least that are free.
_NAMES = range(1, 2000)


@pytest.mark.parametrize('scheme', ('constraint', 'paper'))
def test_a_simulation_gives_all_programs_and_buffers_back(scheme):
    """A long process that makes one cloth after another would fill up with compiled shaders."""
    context = Context(single_thread=True)
    try:
        with take_inventory() as inventory:
            run = Simulation(Scene({
                'rows': 5, 'cols': 6, 'pins': ['none'], 'adaptive.scheme': scheme,
                'air.density': 1.2}), context=context)
            for mode in AVAILABLE:
                run.set_mode(mode)
                run.engines.compile_all()
                run.snapshot()
            made = _programs()
            run.close()
        # One that is in use is there until another is used.
        quick_calls.use_program(0)
        assert made >= len(AVAILABLE)
        assert _programs() == 0
        assert inventory.buffers == []
    finally:
        context.close()


def _programs() -> int:
    """Return how many programs the device has."""
    return sum(bool(GL.glIsProgram(name)) for name in _NAMES)
