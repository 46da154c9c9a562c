# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One extreme scene: what is asked for, and what may come of it."""

from collections.abc import Callable
from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
from typing import Any

from cloth_sim_ros.sim.scene_fields import MODES
import numpy as np

RUNS = 'runs'
REFUSED = 'refused'
STOPS = 'stops'
OUTCOMES = (RUNS, REFUSED, STOPS)

# From rest positions and a random generator to positions, (rows, cols, 3) [m].
Start = Callable[[np.ndarray, np.random.Generator], np.ndarray]


@dataclass(frozen=True)
class Extreme:
    """
    A scene at the end of what can be asked for.

    :param values: scene parameters besides the mode; 8 x 8 nodes where nothing is said
    :param group: of scenes that are told together
    :param modes: it is run in
    :param steps: of dt that are made
    :param push: arguments of ``Simulation.push`` before the first step
    :param start: from the rest positions to others, at rest; None leaves the scene's own start
    :param speed: largest of random velocities at the start [m/s]; 0 leaves the cloth at rest
    :param expected: outcomes that are right
    :param holds_lengths: whether edges can keep their length or limit: nothing begins away from
        it, and nothing pulls beyond it
    :param is_long: whether it takes more than a few seconds
    """

    values: Mapping[str, Any]
    group: str
    modes: tuple[str, ...] = MODES
    steps: int = 20
    push: Mapping[str, Any] = field(default_factory=dict)
    start: Start | None = None
    speed: float = 0.0
    expected: tuple[str, ...] = (RUNS,)
    holds_lengths: bool = True
    is_long: bool = False


def of_all(name: str, value: float) -> dict[str, float]:
    """Return the parameter ``name`` of every family of springs, set to ``value``."""
    return {f'{name}.{family}': value for family in ('structural', 'shear', 'bend')}
