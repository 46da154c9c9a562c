# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One GL context for the simulations of a test process: their programs are compiled once."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
import pytest


@pytest.fixture(scope='session')
def shared_context() -> Iterator[Context]:
    """Lend one context to a whole test process."""
    context = Context(single_thread=True)
    yield context
    context.close()


@pytest.fixture
def context(shared_context: Context) -> Context:
    """Return a context for all simulations that are about something else than contexts."""
    # Another test may have made its own current since.
    shared_context.make_current()
    return shared_context
