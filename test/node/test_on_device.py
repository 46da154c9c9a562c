# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Services and topics that are carried out on the device thread: answered, refused, left out."""

from collections.abc import Callable
from collections.abc import Iterator
import threading
import time
from typing import Any

from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.frame_executor import FrameExecutor
from cloth_sim_ros.node.on_device import listen_on_device
from cloth_sim_ros.node.on_device import serve_on_device
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.sim.errors import ClothSimError
import pytest
import rclpy
from rclpy.context import Context
from std_msgs.msg import Int32
from std_srvs.srv import SetBool

PATIENCE = 300.0


class Idle:
    """Turns in which nothing is done."""

    def turn(self) -> float | None:
        """Wait for a job."""
        return None


class Served:
    """A node with a device thread, and its client."""

    def __init__(self) -> None:
        self._context = Context()
        rclpy.init(context=self._context)
        self.node = rclpy.create_node('on_device', context=self._context)
        self.noted: list[tuple[Exception, str]] = []
        self.device = DeviceThread(
            lambda: events.trigger(), lambda error, where: self.noted.append((error, where)))
        events = self.node.create_guard_condition(self.device.serve)
        self.device.start(lambda: self.device.set_turns(Idle()), lambda: None)
        self._executor = FrameExecutor(self.node)

    def spin_until(self, condition: Callable[[], Any]) -> None:
        """Serve until ``condition`` holds."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end
            self._executor.spin_once(0.1)

    def call(self, data: bool) -> Any:
        """Return the answer of ~/switch."""
        client = self.node.create_client(SetBool, '~/switch')
        self.spin_until(client.service_is_ready)
        future = client.call_async(SetBool.Request(data=data))
        self.spin_until(future.done)
        return future.result()

    def close(self) -> None:
        """End."""
        self.device.close()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self._context)


@pytest.fixture
def served() -> Iterator[Served]:
    """Lend such a node."""
    made = Served()
    yield made
    made.close()


def test_requests_are_answered_with_what_was_done(served):
    """A caller would not know whether, or why not; or ROS would call the device."""
    threads = []

    def switch(request: SetBool.Request, _: SetBool.Response) -> str:
        threads.append(threading.current_thread().name)
        if not request.data:
            raise ClothSimError('it cannot be off: leave it on')
        return 'it is on'

    serve_on_device(served.node, served.device, SetBool, '~/switch', switch)
    answer = served.call(True)
    assert (answer.success, answer.message) == (True, 'it is on')
    answer = served.call(False)
    assert (answer.success, answer.message) == (False, 'it cannot be off: leave it on')
    assert set(threads) == {'device'}


def test_faults_of_the_program_are_no_refusals(served):
    """A fault of the program would look like a mistake of the user."""
    raised = []

    def switch(_: SetBool.Request, __: SetBool.Response) -> str:
        raised.append(1)
        raise ZeroDivisionError('by mistake')

    serve_on_device(served.node, served.device, SetBool, '~/switch', switch)
    with pytest.raises(ZeroDivisionError, match='by mistake'):
        served.call(True)
    assert raised


def test_messages_that_wait_are_the_latest(served):
    """Within a long step a stream would pile up, or the oldest of it be carried out."""
    told, carried_out, holds = [], [], threading.Event()

    def carry_out(message: Int32) -> None:
        if message.data == 6:
            raise ClothSimError('6 makes no sense: give another number')
        if message.data == 7:
            raise ZeroDivisionError('by mistake')
        carried_out.append(message.data)

    listen_on_device(
        served.node, served.device, Int32, '~/numbers', 5, carry_out,
        IgnoredMessages(told.append))
    publisher = served.node.create_publisher(Int32, '~/numbers', 100)
    served.spin_until(lambda: publisher.get_subscription_count() == 1)
    held = threading.Event()
    served.device.post(lambda: held.set() or holds.wait(PATIENCE))
    assert held.wait(PATIENCE)
    for number in range(10):
        publisher.publish(Int32(data=number))
        served.spin_until(lambda number=number: len(served.device._jobs) > number)
    holds.set()
    served.spin_until(lambda: told and served.noted)
    served.device.wait_for(lambda: None)
    assert carried_out == [5, 8, 9]
    (error, where), = served.noted
    assert isinstance(error, ZeroDivisionError) and where == '~/numbers'
    assert len(told) == 1 and '6 makes no sense' in told[0]
