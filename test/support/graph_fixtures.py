# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of tests that talk to nodes; a conftest imports them."""

from collections.abc import Iterator

from graph_client import GraphClient
import pytest
import quick_discovery


@pytest.fixture(scope='session', autouse=True)
def discovery() -> Iterator[None]:
    """Find nodes soon."""
    yield from quick_discovery.quick_discovery()


@pytest.fixture(scope='session')
def client() -> Iterator[GraphClient]:
    """Join the graph once."""
    with GraphClient() as client:
        yield client


@pytest.fixture(autouse=True)
def passing(request: pytest.FixtureRequest) -> Iterator[None]:
    """Let the client give up what one test alone has asked for; fixtures of more come before."""
    if 'client' in request.fixturenames:
        with request.getfixturevalue('client').passing():
            yield
    else:
        yield
