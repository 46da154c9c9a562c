# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Wait for the end of the step under way."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.sim.simulation import Simulation
from rclpy.task import Future


def at_rest(simulation: Simulation, action: Callable[[], Any]) -> Future:
    """Return a future with the result of ``action``, called now or when the step has ended."""
    future = Future()

    def act() -> None:
        try:
            future.set_result(action())
        except Exception as error:
            # Raised where it is awaited: it is the answer of a request, not the end of the step.
            future.set_exception(error)

    simulation.stepping.at_rest(act)
    return future
