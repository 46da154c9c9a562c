# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which loads, block and workgroup step a cloth of springs fastest."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device import layout
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.layout_tuning import tune
from cloth_sim_ros.study.speed import bench_scene
from gpu.clock import seconds_a_step
from gpu.section import Row
from gpu.section import Section

_WORKGROUPS = ((8, 4), (8, 8), (16, 4), (16, 8), (32, 2), (32, 4), (32, 8), (64, 2), (64, 4),
               (16, 16), (128, 1), (128, 2))


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    sides = (32, 128, 512) if context.is_software else (32, 128, 512, 2048)
    for found in tune(context, (16,) if quick else sides, rounds=1 if quick else 3):
        yield {'side': found.side, 'built in': str(found.built_in), 'choice': str(found.choice),
               'rivals': '; '.join(rival.in_words() for rival in found.rivals)}
    # The workgroup is a compile-time choice without a parameter of its own.
    name = '_SOFTWARE_LOCAL' if context.is_software else '_GPU_LOCAL'
    built_in = getattr(layout, name)
    sides = (128,) if context.is_software else (128, 1024, 4096)
    for side in (32,) if quick else sides:
        rates = {}
        for local in _WORKGROUPS[:2] if quick else _WORKGROUPS:
            setattr(layout, name, local)
            with Simulation(bench_scene(side, {}), context=context) as cloth:
                rates[f'{local[0]} x {local[1]}'] = side**2 / seconds_a_step(cloth, 0.03) / 1e9
        setattr(layout, name, built_in)
        yield {'side': side, 'unit': 'G node steps/s', **rates}
    context.close()


SECTION = Section('tuning', 'Layouts and workgroups', 60.0, _measure)
