# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The wind as published on ~/wind."""

from collections.abc import Iterator
import math
from pathlib import Path

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Vector3Stamped
from made_again import assert_same
from node_process import NodeProcess
import pytest
from recorded import Recorded
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from transform_teller import Teller
from transform_teller import transform

NAMESPACE = '/windy'
NAME = f'{NAMESPACE}/cloth_sim'
AIR = {'air.density': 1.225, 'air.wind': [1.0, 0.0, 0.0]}


@pytest.fixture(scope='module')
def windy_node(tmp_path_factory):
    """Start a node whose cloth feels the air."""
    folder = tmp_path_factory.mktemp('windy')
    with NodeProcess(folder, {**PAUSED, **AIR}, '-r', f'__ns:={NAMESPACE}') as node:
        yield node


@pytest.fixture
def cloth(windy_node, client):
    """Listen to the node."""
    return ClothUnderTest(client, {**PAUSED, **AIR}, NAME)


@pytest.fixture
def publisher(cloth) -> Iterator:
    """Return the publisher of the wind."""
    made = cloth.client.node.create_publisher(Vector3Stamped, f'{NAME}/wind', 100)
    cloth.client.spin_until(made.get_subscription_count, 'the node listens')
    yield made
    cloth.client.node.destroy_publisher(made)


def test_the_wind_blows_as_it_is_told_and_as_it_was_recorded(cloth, publisher):
    """A wind would be lost, a bad one taken, or a recorded run not be made again."""
    simulation = Simulation(Scene({**SCENE, **AIR}))
    paths = [Path(cloth.call(StartRecording, 'start_recording').path)]
    publisher.publish(Vector3Stamped(vector=Vector3(x=math.nan)))
    publisher.publish(Vector3Stamped(vector=Vector3(y=2000.0)))
    publisher.publish(Vector3Stamped(header=Header(frame_id='tool0'), vector=Vector3(z=9.0)))
    for number, wind in enumerate([(0.0, 3.0, 0.0), (2.0, -1.0, 4.0), (0.0, 0.0, 5.0)]):
        x, y, z = wind
        publisher.publish(Vector3Stamped(
            header=Header(frame_id='world'), vector=Vector3(x=x, y=y, z=z)))
        cloth.client.spin_until(
            lambda: len(cloth['inputs/wind']) == number + 1, 'the wind is taken')
        assert cloth.call(Step, 'step', steps=7).success
        simulation.set_wind(wind)
        simulation.step(7)
        if number == 1:
            cloth.call(Trigger, 'stop_recording')
            # This one begins in the middle, with a wind that is not that of the parameters.
            paths.append(Path(cloth.call(StartRecording, 'start_recording').path))
            cloth.client.spin_until(lambda: len(cloth['inputs/wind']) == 2, 'no wind is added')
    cloth.call(Trigger, 'stop_recording')
    assert cloth.frame(21).tobytes() == simulation.snapshot().records.tobytes()
    simulation.close()
    told = Recorded(paths[0]).messages('inputs/wind')
    assert [(each.vector.x, each.vector.y, each.vector.z) for each in told] == [
        (0.0, 3.0, 0.0), (2.0, -1.0, 4.0)]
    assert [cloth.steps_of(each) for each in told] == [0, 7]
    for path in paths:
        assert_same(path, node=NAME)


def test_the_wind_of_a_turned_sensor(cloth, publisher):
    """A wind would blow in the direction that it has in the axes of the sensor, or be moved."""
    teller = Teller(cloth)
    sensor = Pose((5.0, 6.0, 7.0), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    teller.tell(transform('sensor', 'world', sensor), is_fixed=True)
    publisher.publish(Vector3Stamped(
        header=Header(frame_id='sensor'), vector=Vector3(x=3.0, z=1.0)))
    wind = cloth.wait_for('inputs/wind').vector
    assert (wind.x, wind.y, wind.z) == pytest.approx((0.0, 3.0, 1.0), abs=1e-12)
    teller.close()
