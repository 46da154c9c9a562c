# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Environments that end with their test."""

from cloth_sim_ros.gym import CarryCloth
from cloth_sim_ros.gym import make_vec
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


@pytest.fixture
def make_many():
    """Return a function that makes several environments of a small cloth, and close them."""
    made = []

    def make_some(num_envs=3, scene=SMALL, **options):
        made.append(make_vec(num_envs, scene, **options))
        return made[-1]

    yield make_some
    for environments in made:
        environments.close()
