# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloths of the paper's Table 10 and Fig. 7 to 9, beside the frame rates that it prints."""

from collections.abc import Iterator
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.paper.cloths import FIGURE_7
from cloth_sim_ros.study.paper.cloths import FIGURE_8
from cloth_sim_ros.study.paper.cloths import FIGURE_9
from cloth_sim_ros.study.paper.cloths import LIMITS
from cloth_sim_ros.study.paper.cloths import square
from cloth_sim_ros.study.paper.cloths import TABLE_10
from cloth_sim_ros.study.paper.printed import edge_count
from gpu.clock import seconds_a_step
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    cloths = (square('constraint', 12), square('adaptive', 12)) if quick else dict.fromkeys(
        (*TABLE_10, *FIGURE_7, *FIGURE_8, *FIGURE_9, *LIMITS))
    for cloth in cloths:
        begin = time.perf_counter()
        try:
            state = cloth.start(context)
        except ImportError as error:
            yield {'left out': f'{cloth.method}, {cloth.nodes} nodes: {error}'}
            continue
        with Simulation(cloth.scene(), context=context, check_stability=False) as run:
            run.warm_up()
            run.set_state(*state)
            run.step(2)
            if cloth.method == 'mass_spring':
                seconds = seconds_a_step(run)
            else:
                run.set_state(*state)
                run.finish()
                first = time.perf_counter()
                run.step(cloth.most_steps)
                run.finish()
                seconds = (time.perf_counter() - first) / cloth.most_steps
        printed = cloth.printed
        yield {
            'method': cloth.method, 'nodes': cloth.nodes,
            'springs': edge_count(cloth.rows, cloth.cols, cloth.families),
            'frames/s': 1.0 / seconds,
            "the paper's GPU": (printed and printed.gpu_fps) or '-',
            "the paper's CPU": (printed and printed.cpu_fps) or '-',
            'section [s]': time.perf_counter() - begin, FAULT: ''}
    context.close()


SECTION = Section('paper', "The paper's cloths", 70.0, _measure)
