# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The codes of responses: programs act on them, not on sentences."""

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.result_codes import code_of
from cloth_sim_ros.recording.recording_faults import RecordingFull
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import pytest
from std_msgs.msg import Header
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

CORNER = Pose(position=Point(x=0.45, y=-0.35, z=1.0))
ELSEWHERE = Header(frame_id='nowhere')
REFUSED = {
    'negative duration': (
        ApplyPush, 'apply_push', {'force': Vector3(z=1.0), 'duration': -1.0}, 'INVALID_VALUE'),
    'no steps': (Step, 'step', {'steps': 0}, 'INVALID_VALUE'),
    'no such mode': (SetMode, 'set_mode', {'mode': 'fluid'}, 'INVALID_VALUE'),
    'no name': (Grasp, 'grasp', {'name': '?'}, 'INVALID_VALUE'),
    'name of a path': (StartRecording, 'start_recording', {'name': '../x'}, 'INVALID_VALUE'),
    'frame of a push': (
        ApplyPush, 'apply_push', {'header': ELSEWHERE, 'duration': 1.0}, 'UNKNOWN_FRAME'),
    'frame of a grasp': (Grasp, 'grasp', {'header': ELSEWHERE, 'name': 'hand'}, 'UNKNOWN_FRAME'),
    'frame of a pin': (MovePin, 'move_pin', {'header': ELSEWHERE}, 'UNKNOWN_FRAME'),
    'own frame that is not there': (
        MoveFrame, 'move_collider', {'name': 'ball', 'header': Header(
            frame_id='handled_cloth_sim_pin_3_3')}, 'UNKNOWN_FRAME'),
    'no collider': (MoveFrame, 'move_collider', {'name': 'nobody'}, 'NOT_FOUND'),
    'no grasp': (MoveFrame, 'move_grasp', {'name': 'nobody'}, 'NOT_FOUND'),
    'no grasp to release': (Release, 'release', {'name': 'nobody'}, 'NOT_FOUND'),
    'no node': (SetPin, 'set_pin', {'row': 99}, 'NOT_FOUND'),
    'no node near': (
        SetPin, 'set_pin', {'use_point': True, 'point': Point(z=9.0)}, 'NOT_FOUND'),
    'no pin': (MovePin, 'move_pin', {'row': 3, 'col': 3}, 'NOT_FOUND'),
    'nothing to grasp': (
        Grasp, 'grasp', {'name': 'hand', 'pose': Pose(position=Point(z=9.0))}, 'NOT_FOUND'),
}


def code_named(name):
    """Return the constant of ResultCode."""
    return getattr(ResultCode, name)


@pytest.mark.parametrize('case', REFUSED)
def test_a_refusal_has_its_code(handled, case):
    """A program would have to read sentences to know what to do."""
    kind, service, fields, name = REFUSED[case]
    answer = handled.call(kind, service, **fields)
    assert not answer.success
    assert answer.code == code_named(name), answer.message


def test_success_has_the_code_0(handled):
    """A program that looks at the code alone would take success for a failure."""
    for kind, service, fields in (
            (Grasp, 'grasp', {'name': 'hand', 'pose': CORNER}),
            (MoveFrame, 'move_grasp', {'name': 'hand', 'pose': CORNER}),
            (ApplyPush, 'apply_push', {'force': Vector3(z=0.1), 'duration': 0.1}),
            (SetPin, 'set_pin', {'row': 4, 'col': 4}),
            (MovePin, 'move_pin', {'row': 4, 'col': 4, 'target': Point(z=1.0)}),
            (Step, 'step', {'steps': 1}),
            (SetMode, 'set_mode', {'mode': 'mass_spring'}),
            (Release, 'release', {})):
        answer = handled.call(kind, service, **fields)
        assert answer.success and answer.code == ResultCode.OK, service


def test_names_that_are_taken(handled):
    """A program could not tell a name that it has to change from a value that is wrong."""
    assert handled.call(Grasp, 'grasp', name='hand', pose=CORNER).success
    taken = handled.call(Grasp, 'grasp', name='hand', pose=CORNER)
    assert (taken.success, taken.code) == (False, ResultCode.NAME_TAKEN)
    assert handled.call(StartRecording, 'start_recording', name='taken').success
    busy = handled.call(StartRecording, 'start_recording', name='other')
    assert (busy.success, busy.code) == (False, ResultCode.WRONG_STATE)
    assert handled.call(Trigger, 'stop_recording').success
    taken = handled.call(StartRecording, 'start_recording', name='taken')
    assert (taken.success, taken.code) == (False, ResultCode.NAME_TAKEN)


def test_what_needs_another_run_state(handled):
    """A program could not tell that it has to pause first."""
    assert handled.call(SetBool, 'pause', data=False).success
    refused = handled.call(Step, 'step', steps=1)
    assert (refused.success, refused.code) == (False, ResultCode.WRONG_STATE)
    assert handled.call(SetBool, 'pause', data=True).success
    # The corner has fallen meanwhile, farther on a busy machine.
    assert handled.call(Trigger, 'reset').success
    # Held by a grasp, a node is no pin.
    assert handled.call(Grasp, 'grasp', name='hand', pose=CORNER).success
    refused = handled.call(SetPin, 'set_pin', row=7, col=9)
    assert (refused.success, refused.code) == (False, ResultCode.WRONG_STATE)


def test_what_is_interrupted(handled):
    """A program would take a run that somebody has stopped for a broken one."""
    for service, kind, fields in (('reset', Trigger, {}), ('pause', SetBool, {'data': True})):
        waiting = handled.client.service(Step, f'{handled.name}/step').call_async(
            Step.Request(steps=100_000))
        # Refused while those are under way: calls of one client are taken in their order.
        assert not handled.call(Step, 'step', steps=1).success
        assert handled.call(kind, service, **fields).success
        handled.client.spin_until(waiting.done, 'the steps end')
        answer = waiting.result()
        assert (answer.success, answer.code) == (False, ResultCode.INTERRUPTED), answer.message


def test_a_state_that_is_lost_and_a_place_that_is_no_folder(client, tmp_path):
    """A program would ask again and again for what cannot go on."""
    values = {**PAUSED, 'recording.directory': str(tmp_path / 'file')}
    (tmp_path / 'file').write_text('')
    with NodeProcess(tmp_path, values, '-r', '__ns:=/lost'):
        cloth = ClothUnderTest(client, values, '/lost/cloth_sim')
        answer = cloth.call(StartRecording, 'start_recording')
        assert (answer.success, answer.code) == (False, ResultCode.NOT_WRITTEN), answer.message
        assert cloth.call(
            ApplyPush, 'apply_push', force=Vector3(x=1e30), duration=1.0).success
        answer = cloth.call(Step, 'step', steps=100)
        assert (answer.success, answer.code) == (False, ResultCode.RUN_STOPPED), answer.message


@pytest.mark.parametrize(('error', 'name'), [
    (NonFiniteStateError('', steps=1), 'RUN_STOPPED'),
    (RecordingFull(''), 'NOT_WRITTEN'),
    (ClothSimError(''), 'INVALID_VALUE'),
    (ZeroDivisionError(''), 'UNEXPECTED')])
def test_each_error_has_one_code(error, name):
    """The code of a kind of errors would be that of a wider one."""
    assert code_of(error) == code_named(name)
