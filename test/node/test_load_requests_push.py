# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes by service, by message and by a click."""

from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Step
from geometry_msgs.msg import Point
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import Vector3
import pytest
from std_msgs.msg import Header
from std_srvs.srv import Trigger

NAN, INF = float('nan'), float('inf')
GOOD = {
    'force': Vector3(z=2.0), 'region': 'sphere', 'center': Point(z=1.0), 'radius': 0.3,
    'duration': 0.1,
}
BAD = {
    'force NaN': ({'force': Vector3(x=NAN)}, 'force of a push must be 3 finite'),
    'infinite force': ({'force': Vector3(y=-INF)}, 'force of a push must be 3 finite'),
    'center NaN': ({'center': Point(y=NAN)}, 'center of a push must be 3 finite'),
    'negative radius': ({'radius': -1.0}, 'radius of a push must be from 0 to 1e+06 m'),
    'infinite radius': ({'radius': INF}, 'radius of a push must be from 0 to 1e+06 m'),
    'radius NaN': ({'radius': NAN}, 'radius of a push must be from 0 to'),
    'radius beyond all squares': ({'radius': 1e200}, 'got 1e+200 m: give it in metres'),
    'no radius': ({'radius': 0.0}, 'needs a radius above 0'),
    'no duration': ({'duration': 0.0}, 'duration of a push must be above 0 and at most'),
    'negative duration': ({'duration': -0.1}, 'duration of a push must be above 0 and at most'),
    'duration NaN': ({'duration': NAN}, 'duration of a push must be above 0'),
    'infinite duration': ({'duration': INF}, 'duration of a push must be above 0'),
    'unknown region': ({'region': 'cube'}, "needs the region all or sphere, got 'cube'"),
    'a place without cloth': ({'center': Point(z=9.0)}, 'no free node'),
}


def test_tells_nodes_and_impulse(cloth):
    """A caller could not see which nodes the push acts on."""
    response = cloth.call(ApplyPush, 'apply_push', force=Vector3(x=1.0, z=-2.0), duration=0.25)
    assert response.success
    assert response.nodes == 8 * 10 - 2, 'every node but the two pins; no region means all'
    assert response.impulse == Vector3(x=0.25, z=-0.5)


def test_is_told_as_an_input(cloth):
    """A recording could not be run again, for want of the push."""
    cloth.call(Step, 'step', steps=6)
    cloth.call(ApplyPush, 'apply_push', **GOOD)
    told = cloth.wait_for('inputs/push')
    assert (told.force, told.region, told.center) == (GOOD['force'], 'sphere', GOOD['center'])
    assert (told.radius, told.duration) == (0.3, 0.1)
    assert told.start == pytest.approx(6 * cloth.dt)
    assert cloth.steps_of(told) == 6


@pytest.mark.parametrize('case', BAD)
def test_refuses_nonsense(cloth, case):
    """A bad push would be accepted, and make the cloth NaN."""
    change, reason = BAD[case]
    response = cloth.call(ApplyPush, 'apply_push', **{**GOOD, **change})
    assert not response.success
    assert reason in response.message
    assert (response.nodes, response.impulse) == (0, Vector3())
    assert cloth.call(Trigger, 'clear_pushes').message == '0 pushes cleared'


def test_refused_pushes_leave_the_motion_as_it_is(cloth, simulation):
    """A refused push would move the cloth all the same."""
    for change, _ in BAD.values():
        cloth.call(ApplyPush, 'apply_push', **{**GOOD, **change})
    cloth.call(Step, 'step', steps=10)
    simulation.step(10)
    assert cloth.frame(10).tobytes() == simulation.snapshot().records.tobytes()
    assert not cloth['inputs/push']


def test_clear_ends_the_pushes(cloth, simulation):
    """A push would go on after it was cleared, or the recording would not know."""
    cloth.call(ApplyPush, 'apply_push', force=Vector3(z=5.0), duration=10.0)
    assert cloth.call(Trigger, 'clear_pushes').message == '1 pushes cleared'
    assert cloth.wait_for('inputs/command').command == 'clear_pushes'
    cloth.call(Step, 'step', steps=10)
    simulation.step(10)
    assert cloth.frame(10).tobytes() == simulation.snapshot().records.tobytes()


def test_push_message_does_what_the_service_does(cloth, simulation):
    """A push on the topic would be lost, or push in another way; or its start would be."""
    publisher = cloth.client.node.create_publisher(Push, f'{cloth.name}/push', 10)
    cloth.client.spin_until(publisher.get_subscription_count, 'the node listens')
    publisher.publish(Push(force=Vector3(z=NAN), duration=0.05))
    publisher.publish(Push(force=Vector3(z=1.5), duration=0.05, start=0.02))
    told = cloth.wait_for('inputs/push')
    assert (told.force.z, told.start) == (1.5, 0.02)
    cloth.call(Step, 'step', steps=20)
    simulation.push((0.0, 0.0, 1.5), duration=0.05, start=0.02)
    simulation.step(20)
    assert cloth.frame(20).tobytes() == simulation.snapshot().records.tobytes()
    cloth.client.node.destroy_publisher(publisher)


def test_push_message_of_an_unknown_frame_is_ignored(cloth):
    """A push given in a frame that nobody knows would act somewhere, in some direction."""
    publisher = cloth.client.node.create_publisher(Push, f'{cloth.name}/push', 10)
    cloth.client.spin_until(publisher.get_subscription_count, 'the node listens')
    for frame, z in (('tool0', 1.0), ('world', 2.0), ('', 3.0)):
        publisher.publish(Push(
            header=Header(frame_id=frame), force=Vector3(z=z), duration=0.05))
    cloth.wait_for('inputs/push', lambda push: push.force.z == 3.0)
    assert [push.force.z for push in cloth['inputs/push']] == [2.0, 3.0]
    cloth.client.node.destroy_publisher(publisher)


def test_click_pushes_where_it_hits(cloth):
    """A click in RViz would do nothing, push elsewhere, or be taken from a foreign frame."""
    clicks = cloth.client.node.create_publisher(PointStamped, '/clicked_point', 10)
    cloth.client.spin_until(clicks.get_subscription_count, 'the node listens')
    place = Point(x=0.1, y=0.0, z=1.0)
    cloth.set_parameters(clicked_point__force=[0.0, 0.0, 3.0], clicked_point__radius=0.25)
    clicks.publish(PointStamped(header=Header(frame_id='elsewhere'), point=Point(z=1.0)))
    clicks.publish(PointStamped(header=Header(frame_id='world'), point=Point(z=50.0)))
    clicks.publish(PointStamped(header=Header(frame_id='world'), point=place))
    told = cloth.wait_for('inputs/push')
    assert (told.region, told.center, told.radius) == ('sphere', place, 0.25)
    assert (told.force, told.duration) == (Vector3(z=3.0), 0.1)
    cloth.client.node.destroy_publisher(clicks)
