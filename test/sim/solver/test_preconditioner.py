# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Levels that one workgroup goes through do what passes over each of them do."""

from collections.abc import Callable
from collections.abc import Iterator
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
import numpy as np
import pytest


@pytest.fixture
def solve(context: Context, make_case: Callable[..., Any]) -> Iterator[Callable[..., Any]]:
    """Return a function from scene values to a solution, and the shaders that have found it."""
    def run(values: dict[str, Any], *, is_software: bool) -> tuple[np.ndarray, set[str]]:
        context.is_software = is_software
        with take_inventory() as inventory:
            solution = make_case(
                {'loads': 'storage', **values}, kind='hard', tolerance=1e-6,
                max_iterations=12).solve()
        return solution, {
            program.name for program in inventory.programs if program.dispatches}

    yield run
    context.is_software = True


@pytest.mark.parametrize('values', [
    {'rows': 5, 'cols': 7}, {'rows': 33, 'cols': 37}, {'rows': 97, 'cols': 70},
    {'rows': 33, 'cols': 37, 'bending.rigidity': 1e-4}],
    ids=['one level', 'all levels', 'not the first', 'rigid'])
def test_one_workgroup_has_the_bits_of_passes(solve, values):
    """A cloth would move differently on a GPU, for which this is quicker."""
    by_passes, of_passes = solve(values, is_software=True)
    together, of_together = solve(values, is_software=False)
    assert {'solver/coarse_levels.comp', 'solver/coarse_systems.comp'} <= of_together - of_passes
    assert {'solver/coarsest.comp', 'solver/invert.comp'} <= of_passes
    assert np.any(by_passes != 0.0)
    assert np.array_equal(by_passes, together)
