# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A running cloth node together with everything it says."""

from collections.abc import Mapping
import time
from typing import Any

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import FollowFrame
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from graph_client import GraphClient
from graph_client import PATIENCE
from graph_client import Watch
import numpy as np
from rcl_interfaces.srv import DescribeParameters
from rcl_interfaces.srv import GetParameters
from rcl_interfaces.srv import ListParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

# Other tests may run a node without a namespace at the same time.
NAMESPACE = '/node_tests'
NAME = f'{NAMESPACE}/cloth_sim'
SCENE = {
    'rows': 8, 'cols': 10, 'width': 0.9, 'height': 0.7, 'stiffness.structural': 40.0,
    'stiffness.shear': 30.0, 'stiffness.bend': 5.0, 'damping.structural': 0.02, 'dt': 0.005,
}
SERVICES = {
    'set_mode': SetMode,
    'apply_push': ApplyPush,
    'clear_pushes': Trigger,
    'set_pin': SetPin,
    'move_pin': MovePin,
    'grasp': Grasp,
    'release': Release,
    'move_grasp': MoveFrame,
    'move_collider': MoveFrame,
    'follow_grasp': FollowFrame,
    'follow_collider': FollowFrame,
    'reset': Trigger,
    'pause': SetBool,
    'step': Step,
    'start_recording': StartRecording,
    'stop_recording': Trigger,
    'get_parameters': GetParameters,
    'describe_parameters': DescribeParameters,
    'list_parameters': ListParameters,
    'set_parameters_atomically': SetParametersAtomically,
}
PAUSED = {**SCENE, 'start_paused': True}
# The same cloth above a ball and a floor, which are its only colliders.
HANDLED = {
    **SCENE, 'colliders.names': ['ball', 'floor'], 'colliders.ball.size': [0.1],
    'colliders.ball.position': [0.0, 0.0, 0.85], 'colliders.floor.shape': 'plane',
    'colliders.floor.position': [0.0, 0.0, 0.2]}
HANDLED_NAME = '/handled/cloth_sim'


class ClothUnderTest:
    """
    Call the services of a node and keep the messages of all its topics.

    :param values: what differs from the defaults in the node's parameters
    :param name: of the node, with its namespace
    """

    def __init__(
            self, client: GraphClient, values: Mapping[str, Any], name: str = NAME) -> None:
        """Subscribe to everything, and wait until the node knows that."""
        self.client = client
        self.name = name
        self.dt = values['dt']
        self._shape = (values['rows'], values['cols'])
        for service, kind in SERVICES.items():
            client.service(kind, f'{name}/{service}')
        self._topics: dict[str, Watch] = {
            key: client.watch(topic.message, topic.full_name(name), kept=topic.transient_local)
            for key, topic in TOPICS.items() if key != 'clock'}
        self._shake_hands()

    def _shake_hands(self) -> None:
        # The node learns of clients and subscriptions in their order, and does not answer a
        # client that it does not know yet: it knows them all when the last one hears something.
        set_parameters = self.client.service(
            SetParametersAtomically, f'{self.name}/set_parameters_atomically')
        deadline = time.monotonic() + PATIENCE
        while not self['inputs/parameters']:
            assert time.monotonic() < deadline, f'{self.name} takes no parameters'
            set_parameters.call_async(SetParametersAtomically.Request(
                parameters=_as_messages({'real_time_factor': 1.0})))
            self.client.spin_for(0.2)

    def __getitem__(self, key: str) -> list[Any]:
        """Return the messages of the topic ``key`` since the last clear."""
        return self._topics[key].messages

    def clear(self) -> None:
        """Forget all messages."""
        for watch in self._topics.values():
            watch.clear()

    def call(self, kind: type, name: str, /, **fields: Any) -> Any:
        """Return the answer of the node's service ``name``."""
        return self.client.call(kind, f'{self.name}/{name}', **fields)

    def set_parameters(self, **values: Any) -> Any:
        """Set parameters at once; __ in a name stands for a dot. Return the result."""
        return self.call(
            SetParametersAtomically, 'set_parameters_atomically',
            parameters=_as_messages(values)).result

    def wait_for(self, key: str, condition: Any = None) -> Any:
        """Return the first message of ``key`` since the last clear that ``condition`` likes."""
        likes = condition or (lambda message: True)
        seen = 0

        def liked() -> Any:
            nonlocal seen
            fresh = self[key][seen:]
            seen += len(fresh)
            return next(filter(likes, fresh), None)

        return self.client.spin_until(liked, f'a message on {key}')

    def frame(self, steps: int) -> np.ndarray:
        """Return the points after ``steps`` steps as an array of POINT_DTYPE."""
        return self.points_of(self.wait_for('points', lambda cloud: self.steps_of(cloud) == steps))

    def points_of(self, cloud: Any) -> np.ndarray:
        """Return a PointCloud2 as an array of POINT_DTYPE."""
        return np.frombuffer(bytes(cloud.data), dtype=POINT_DTYPE).reshape(self._shape)

    def steps_of(self, message: Any) -> float:
        """Return the steps of dt that the stamp of ``message`` amounts to."""
        time = message.header.stamp
        return (time.sec * 10**9 + time.nanosec) / nanoseconds(self.dt)

    def restore(self) -> None:
        """Go back to the start, paused, not recording, with the parameters of the start."""
        self.call(SetBool, 'pause', data=True)
        self.call(Trigger, 'stop_recording')
        self.call(Trigger, 'clear_pushes')
        assert self.set_parameters(**{
            field.name: list(field.default) if field.is_array else field.default
            for field in FIELDS if field.live}).successful
        self.clear()
        assert self.call(Trigger, 'reset').success
        self.frame(0)
        self.client.spin_until(lambda: self['state'] and self['stats'], 'the reset is reported')
        # What a run before it has published may still stand in the queues.
        self.client.spin_until_quiet()
        self.clear()


def _as_messages(values: Mapping[str, Any]) -> list[Any]:
    return [
        Parameter(name.replace('__', '.'), value=value).to_parameter_msg()
        for name, value in values.items()]
