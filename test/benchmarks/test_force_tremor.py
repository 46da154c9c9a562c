# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How still the force at the pins is."""

from force_tremor import SCENES
from force_tremor import tremor


def test_a_chain_that_is_solved_hangs_still():
    """The study would see a tremor where there is none, or take another force for the weight."""
    chain = next(iter(SCENES.values()))
    mean, deviation, moved = tremor(chain, 1.5)
    assert abs(mean - 1.0) < 1e-3
    assert deviation < 1e-3
    assert moved < 1e-5
