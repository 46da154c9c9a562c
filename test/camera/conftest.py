# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths of known shape, and cameras that are closed in the end."""

from collections.abc import Callable
from collections.abc import Iterator
from typing import Any

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from seen_cloths import FALLING


@pytest.fixture
def camera() -> Iterator[Callable[..., Camera]]:
    """Return a function that makes a camera."""
    made = []

    def make(**values: Any) -> Camera:
        made.append(Camera(**values))
        return made[-1]

    yield make
    for each in made:
        each.close()


@pytest.fixture(scope='session')
def fallen() -> Iterator[Simulation]:
    """Let a cloth fall onto a ball that stands on the ground; nobody changes it."""
    with Simulation(Scene(FALLING)) as simulation:
        simulation.advance(0.5)
        yield simulation
