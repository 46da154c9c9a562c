# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Long frames, and a run whose state stops being finite."""

from signal import SIGINT

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

TOO_MUCH = {'force': Vector3(x=1e30), 'duration': 1.0}


def test_stops_when_the_state_is_not_finite_and_reset_mends_it(client, tmp_path):
    """A cloth of NaN would be published for ever, or the node could not be used any more."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/blow_up') as node:
        cloth = ClothUnderTest(client, SCENE, '/blow_up/cloth_sim')
        cloth.wait_for('stats', lambda stats: stats.steps > 0)
        assert cloth.call(ApplyPush, 'apply_push', **TOO_MUCH).success
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        assert 'no longer finite at' in node.output and 'call ~/reset' in node.output

        assert not cloth.call(SetBool, 'pause', data=False).success
        assert 'call ~/reset' in cloth.call(Step, 'step', steps=1).message
        assert cloth.call(SetPin, 'set_pin', row=1, col=1).success, 'services still answer'
        assert all(cloth.points_of(cloud)['x'].max() < 1e30 for cloud in cloth['points'])

        cloth.clear()
        assert cloth.call(Trigger, 'reset').success
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        cloth.wait_for('stats', lambda stats: stats.steps > 20)


def test_a_step_into_the_same_is_told_too(cloth):
    """A paused cloth would be stepped on as NaN, or forget that it was paused."""
    cloth.call(ApplyPush, 'apply_push', **TOO_MUCH)
    cloth.call(Step, 'step', steps=50)
    cloth.wait_for('state', lambda state: state.run_state == 'stopped')
    assert not cloth.call(Step, 'step', steps=1).success
    cloth.call(Trigger, 'reset')
    cloth.wait_for('state', lambda state: state.run_state == 'paused')
    assert cloth.call(Step, 'step', steps=1).success


def test_services_are_answered_during_a_long_frame(client, tmp_path):
    """A low rate of frames would make the node deaf, to requests and to being stopped."""
    slow = {**SCENE, 'publish.rate': 0.001, 'dt': 1e-4}
    with NodeProcess(tmp_path, slow, '-r', '__ns:=/long_frame') as node:
        cloth = ClothUnderTest(client, slow, '/long_frame/cloth_sim')
        assert cloth.call(SetBool, 'pause', data=True).success
        assert 0.0 < cloth.call(Step, 'step', steps=1).sim_time < 1000.0
        assert cloth.call(SetBool, 'pause', data=False).success
        node.send(SIGINT)
        assert node.wait() == 0
