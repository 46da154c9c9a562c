# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the engines of a cloth leave behind on the device."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS

# Names that GL gives to shaders and programs are the least that are free.
_NAMES = range(1, 2000)


@pytest.mark.parametrize('scheme', ('constraint', 'paper'))
def test_a_simulation_leaves_its_programs_to_the_next_and_no_buffers(scheme):
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
