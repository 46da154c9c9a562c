# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every pass of every mode compiles and runs; how long a mode takes to compile."""

from collections.abc import Iterator
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.cases import Case
from gpu.cases import CASES
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section

# Passes that only other commands run: `cloth_sim paper` and Batch.
_ELSEWHERE = ('paper/solver/', 'place_pins.comp')
# A pass that software does not use.
_OF_GPUS = 'mass_spring_tile.comp'
_LAYOUTS = ((1, 'storage'), (2, 'storage'), (4, 'storage'), (1, 'texture'), (2, 'texture'))


def _variants(case: Case, quick: bool) -> Iterator[Scene]:
    """Yield the scene with each block and way of loading; alone where its layout has one."""
    scene = case.scene()
    if quick or scene['layout'] == 'paper' or scene['mode'] != 'mass_spring':
        yield scene
        return
    for block, loads in _LAYOUTS:
        yield Scene({**scene.values, 'block': block, 'loads': loads})


def _measure(quick: bool) -> Iterator[Row]:
    context = Context(single_thread=True)
    run = set()
    chosen = CASES[::5] if quick else CASES
    for case in chosen:
        for scene in _variants(case, quick):
            begin = time.perf_counter()
            fault = ''
            with take_inventory() as inventory:
                try:
                    with Simulation(scene, context=context) as cloth:
                        cloth.warm_up()
                        cloth.step(2)
                        cloth.snapshot(tension=True)
                        cloth.finish()
                except Exception as error:
                    fault = f'{type(error).__name__}: {str(error)[:500]}'
            run |= {program.name for program in inventory.programs if program.dispatches}
            yield {'case': case.name, 'block': scene['block'], 'loads': scene['loads'],
                   'programs': len(inventory.programs),
                   'compile and run [s]': time.perf_counter() - begin, FAULT: fault}
    root = shader_directory()
    never = sorted(
        name for path in root.rglob('*.comp')
        if (name := str(path.relative_to(root))) not in run
        and not name.startswith(_ELSEWHERE)
        and not (context.is_software and name == _OF_GPUS))
    yield {'passes run': len(run), 'passes never run': ', '.join(never),
           FAULT: 'not all passes were run' if never and not quick else ''}
    context.close()


SECTION = Section('shaders', 'Compilation', 60.0, _measure)
