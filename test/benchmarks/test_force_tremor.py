# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How still the force at the pins is."""

from force_tremor import SCENES
from force_tremor import tremor
from measured import within
import pytest

CHAIN = next(iter(SCENES.values()))


@pytest.mark.parametrize('scheme', ['constraint', 'list', 'lattice', 'whole'])
def test_a_chain_that_is_solved_hangs_still(scheme):
    """The study would see a tremor where there is none, or take another force for the weight."""
    mean, deviation, moved, switching = tremor({**CHAIN, 'adaptive.scheme': scheme}, 1.5)
    within('mean force, off the weight, over it', abs(mean - 1.0), 1e-4)
    within('standard deviation of the force over the weight', deviation, 1e-4)
    within('distance that nodes move [m]', moved, 1e-6)
    within('edges that switch in a step over those held', switching, 0.01)


@pytest.mark.parametrize('nodes', [64, 128])
def test_a_long_chain_hangs_still(nodes):
    """Rounds end before they have come along a chain, and each substep throws it anew."""
    mean, deviation, moved, switching = tremor({**CHAIN, 'rows': nodes, 'dt': 0.01}, 4.0)
    within('mean force, off the weight, over it', abs(mean - 1.0), 1e-3)
    within('standard deviation of the force over the weight', deviation, 1e-3)
    within('distance that nodes move [m]', moved, 1e-5)
    within('edges that switch in a step over those held', switching, 0.01)


@pytest.mark.long
def test_a_damped_cloth_on_two_corners_hangs_still():
    """Hundreds of edges at their limit would come and go, and throw the cloth."""
    values = SCENES['32 x 32 nodes on two corners, damped, limit 10 %']
    mean, deviation, moved, switching = tremor(values, 12.0)
    within('mean force, off the weight, over it', abs(mean - 1.0), 1e-4)
    within('standard deviation of the force over the weight', deviation, 1e-3)
    within('distance that nodes move [m]', moved, 1e-5)
    within('edges that switch in a step over those held', switching, 0.01)
