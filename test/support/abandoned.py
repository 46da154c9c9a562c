# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps that are abandoned in their midst, and how often they ask whether they are to be."""

from collections.abc import Callable

from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned
import pytest


class StopAfter:
    """
    A Stop that asks for it from one call on.

    :param calls: how many come before, which return False
    """

    def __init__(self, calls: float) -> None:
        """Begin to count."""
        self._most = calls
        self.calls = 0

    def __call__(self) -> bool:
        """Count, and return whether there were that many before."""
        self.calls += 1
        return self.calls > self._most


def abandon(
        simulation: Simulation, *, steps: int, after: int,
        error: type[BaseException] = StepAbandoned) -> None:
    """
    Aim at ``steps`` steps of dt, and leave them.

    :param after: calls of the stop that return False
    :param error: raised in the next call, instead of True, where it is not StepAbandoned
    """
    stop = StopAfter(after)
    simulation.stepping.aim_steps(steps)
    with pytest.raises(error):
        simulation.work(stop=stop if error is StepAbandoned else _raising(error, stop))


def _raising(error: type[BaseException], stop: StopAfter) -> Callable[[], bool]:
    def ask() -> bool:
        if stop():
            raise error
        return False

    return ask


def calls_of(simulation: Simulation, *, steps: int) -> int:
    """Make ``steps`` steps of dt, and return how often they have asked."""
    stop = StopAfter(float('inf'))
    simulation.stepping.aim_steps(steps)
    simulation.work(stop=stop)
    return stop.calls
