# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A warning of a cloth that starts inside a body."""

import warnings

from cloth_sim_ros.sim.contact.start_inside import warn_of_start_inside
from cloth_sim_ros.sim.scene import Scene
import pytest

# 11 x 11 nodes, 5 cm apart, at z = 0.5 m over a box whose top is at 0.4 m.
ABOVE = {
    'rows': 11, 'cols': 11, 'width': 0.5, 'height': 0.5, 'start.z': 0.5, 'pins': ['none'],
    'colliders.names': ['table'], 'colliders.table.shape': 'box',
    'colliders.table.size': [0.24, 0.24, 0.4], 'colliders.table.position': [0.0, 0.0, 0.2]}


def test_start_inside_a_box():
    """A user whose scene has the cloth in the table would only see a wild motion."""
    with pytest.warns(UserWarning, match='25 nodes start inside table, up to 0.1 m deep'):
        warn_of_start_inside(Scene({**ABOVE, 'start.z': 0.3}))


@pytest.mark.parametrize('changes', [
    {}, {'start.z': 0.38}, {'start.z': 0.3, 'pins': ['all']},
    {'start.z': 0.3, 'colliders.table.position': [0.0, 0.0, -0.2]}])
def test_no_warning(changes):
    """A cloth above or on a body, or held in it, would bring a warning in vain."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        warn_of_start_inside(Scene({**ABOVE, **changes}))
