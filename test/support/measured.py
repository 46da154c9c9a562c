# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A figure beside its limit."""


def within(what: str, value: float, limit: float) -> None:
    """Print a figure and fail where it is above its limit."""
    print(f'measured {value:.1e} of {limit:g} allowed: {what}')
    assert value <= limit, what
