# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The context that rows are measured in."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
import pytest


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Lend one context to the tests of a file."""
    context = Context(single_thread=True)
    yield context
    context.close()
