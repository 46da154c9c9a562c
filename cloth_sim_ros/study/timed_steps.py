# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long steps take until the device has made them."""

import time

from cloth_sim_ros.sim.simulation import Simulation


def time_steps(run: Simulation, count: int) -> float:
    """Make ``count`` steps of dt and return the wall time [s]."""
    run.finish()
    begin = time.perf_counter()
    run.step(count)
    run.finish()
    return time.perf_counter() - begin
