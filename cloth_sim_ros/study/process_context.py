# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One GL context for all the small runs that a process makes, one after the other."""

from functools import cache

from cloth_sim_ros.gl.context import Context


@cache
def process_context() -> Context:
    """Return the context of this process, made when it is first asked for; not to be closed."""
    return Context(single_thread=True)
