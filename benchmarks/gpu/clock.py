# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Wall time of repeated work on the device."""

from collections.abc import Callable
import statistics
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.simulation import Simulation

# Wall time of a turn [s]: long beside the microseconds of a submission.
TURN = 0.1
ROUNDS = 5


def seconds_each(run: Callable[[], object], context: Context, turn: float = TURN) -> float:
    """Return the wall time of one ``run`` [s], median of ROUNDS turns after a first one."""
    def timed(count: int) -> float:
        context.finish()
        begin = time.perf_counter()
        for _ in range(count):
            run()
        context.finish()
        return (time.perf_counter() - begin) / count

    timed(1)
    count = max(1, round(turn / timed(2)))
    return statistics.median(timed(count) for _ in range(ROUNDS))


def seconds_a_step(cloth: Simulation, turn: float = TURN) -> float:
    """Return the wall time of a step of dt [s], steps made in one call, median of ROUNDS turns."""
    def timed(count: int) -> float:
        cloth.finish()
        begin = time.perf_counter()
        cloth.step(count)
        cloth.finish()
        return (time.perf_counter() - begin) / count

    timed(2)
    count = max(1, round(turn / timed(2)))
    return statistics.median(timed(count) for _ in range(ROUNDS))
