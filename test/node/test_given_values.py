# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node takes a cloth by its weight and by points, as the commands do."""

from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_under_test import ClothUnderTest
from node_process import NodeProcess
import numpy as np
from rcl_interfaces.srv import GetParameters
from std_srvs.srv import Trigger

GIVEN = {
    'rows': 5, 'cols': 7, 'width': 0.6, 'height': 0.4, 'total_mass': 0.3,
    'pin_points.positions': [-0.31, 0.2, 1.0, 0.2, -0.19, 1.01],
    'stiffness.structural': [150.0, 80.0],
    'dt': 0.005, 'start_paused': True}


def test_weight_and_points_in_parameters_and_pins(client, tmp_path):
    """The node would add the default weight or pins, which the commands leave out."""
    with NodeProcess(tmp_path, GIVEN, '-r', '__ns:=/given'):
        cloth = ClothUnderTest(client, GIVEN, '/given/cloth_sim')
        names = [
            'total_mass', 'areal_density', 'pins', 'pin_points.positions', 'stiffness.structural']
        total, density, pins, points, structural = cloth.call(
            GetParameters, 'get_parameters', names=names).values
        cloth.call(Trigger, 'reset')
        flags = cloth.frame(0)['flags']
    assert (total.double_value, density.double_value) == (0.3, 0.0)
    assert list(pins.string_array_value) == ['none']
    assert list(structural.double_array_value) == GIVEN['stiffness.structural']
    np.testing.assert_array_equal(points.double_array_value, GIVEN['pin_points.positions'])
    assert np.argwhere(flags & FLAG_PINNED).tolist() == [[0, 0], [4, 5]]
