# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The node steps as its preset says, where its parameters leave that open."""

from cloth_sim_ros.sim.scene import Scene
from cloth_under_test import ClothUnderTest
from node_process import NodeProcess
from rcl_interfaces.srv import GetParameters

GIVEN = {'rows': 6, 'cols': 6, 'preset': 'balanced', 'start_paused': True}


def test_a_preset_shows_in_the_parameters_it_sets(client, tmp_path):
    """A preset would do nothing, or a parameter tell another value than the one in use."""
    scene = Scene({name: value for name, value in GIVEN.items() if name != 'start_paused'})
    given = {**GIVEN, 'dt': 0.01}
    with NodeProcess(tmp_path, given, '-r', '__ns:=/presets'):
        cloth = ClothUnderTest(client, given, '/presets/cloth_sim')
        names = ['refine', 'mode', 'preset', 'dt']
        answer = cloth.call(GetParameters, 'get_parameters', names=names).values
    assert answer[0].integer_value == scene['refine']
    assert answer[1].string_value == scene['mode']
    assert answer[2].string_value == 'balanced'
    assert answer[3].double_value == 0.01
