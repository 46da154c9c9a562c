# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the arrows of the pushes stand."""

from cloth_sim_ros.messages.push_arrows import push_arrows
from cloth_sim_ros.sim.push import Push
import numpy as np

NODES = np.array([[0.0, 0.0, 1.0], [2.0, 4.0, 1.0]])


def test_only_pushes_that_act_are_shown():
    """A push would show before it begins or after it ends."""
    push = Push.checked(force=(0.0, 0.0, 2.0), start=1.0, duration=0.5)
    shown = [len(push_arrows([push], time, NODES, 1.0)) for time in (0.99, 1.0, 1.49, 1.5)]
    assert shown == [0, 1, 1, 0]


def test_arrows_stand_in_their_region_and_point_along_the_force():
    """A push would show somewhere else, in another direction or strength."""
    everywhere = Push.checked(force=(0.0, 0.0, -4.0), start=0.0, duration=1.0)
    sphere = Push.checked(
        force=(2.0, 0.0, 0.0), start=0.0, duration=1.0, region='sphere',
        center=(5.0, 6.0, 7.0), radius=0.1)
    first, second = push_arrows([everywhere, sphere], 0.5, NODES, 0.3)
    np.testing.assert_allclose(first, [[1.0, 2.0, 1.0], [1.0, 2.0, 0.7]])
    np.testing.assert_allclose(second, [[5.0, 6.0, 7.0], [5.15, 6.0, 7.0]])


def test_a_push_without_force_has_no_arrow():
    """The arrow of a zero force would have a direction that is not a number."""
    push = Push.checked(force=(0.0, 0.0, 0.0), start=0.0, duration=1.0)
    assert push_arrows([push], 0.5, NODES, 1.0) == []
