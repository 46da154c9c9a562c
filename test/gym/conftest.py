# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Environments that end with their test."""

from cloth_sim_ros.gym import CarryCloth
import pytest
from small_environment import SMALL


@pytest.fixture
def make():
    """Return a function that makes environments of a small cloth, and close them."""
    made = []

    def make_one(scene=SMALL, **options):
        made.append(CarryCloth(scene, **options))
        return made[-1]

    yield make_one
    for environment in made:
        environment.close()
