# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A place in the graph for attacks, and their seed."""

from collections.abc import Iterator
import random

from forked_verbs import ForkedVerbs
from graph_fixtures import client  # noqa: F401
from graph_fixtures import discovery  # noqa: F401
from graph_fixtures import passing  # noqa: F401
import pytest

_USUAL = 20261122


@pytest.fixture(scope='session')
def verbs() -> Iterator[ForkedVerbs]:
    """Return what runs verbs."""
    with ForkedVerbs() as running:
        yield running


@pytest.fixture
def seed(request: pytest.FixtureRequest) -> int:
    """Draw a seed, or take the one of --seed, and print it."""
    given = request.config.getoption('--seed')
    return _printed(random.SystemRandom().randrange(2**31) if given is None else given)


@pytest.fixture
def usual_seed(request: pytest.FixtureRequest) -> int:
    """Take the same seed each time, or the one of --seed, and print it."""
    given = request.config.getoption('--seed')
    return _printed(_USUAL if given is None else given)


def _printed(seed: int) -> int:
    print(f'to draw the same again, give --seed {seed}')
    return seed
