# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a cloth compiles depends on what it models, not on its size or on pushes."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Lend one context to all, which saves time."""
    context = Context(single_thread=True)
    yield context
    context.close()


def compiled(simulation: Simulation, *, pushed: bool = False) -> set[str]:
    """Return the texts of the programs that a step and a snapshot of it compile."""
    with take_inventory() as inventory:
        if pushed:
            simulation.push(
                (0.0, 0.0, 1.0), duration=1.0, region='sphere', center=(0.0, 0.0, 1.0), radius=0.3)
        simulation.set_mode(simulation.mode)
        simulation.step(2)
        simulation.snapshot()
        return {program.source.text for program in inventory.programs}


@pytest.mark.parametrize('mode', AVAILABLE)
def test_a_program_serves_every_size(context, mode: str):
    """Each new size of cloth would compile for seconds on a machine that has run others."""
    texts = []
    for rows, cols in ((12, 12), (20, 33), (40, 40)):
        with take_inventory() as inventory:
            simulation = Simulation(
                Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'mode': mode}), context=context)
            simulation.step(2)
            simulation.snapshot()
            texts.append({program.source.text: program.name for program in inventory.programs})
            simulation.close()
    assert texts[1] == texts[2]
    # A narrow cloth has other blocks of nodes to step, of which nothing else knows.
    assert {name for text, name in texts[0].items() if text not in texts[1]} <= {
        'mass_spring_step.comp'}


@pytest.mark.parametrize('mode', AVAILABLE)
def test_the_first_push_on_a_region_compiles_nothing(context, mode: str):
    """A push would stop the cloth for as long as the compiler takes."""
    simulation = Simulation(Scene({
        **SPRINGS, 'rows': 12, 'cols': 12, 'mode': mode}), context=context)
    assert compiled(simulation)
    assert not compiled(simulation, pushed=True)
    simulation.close()
