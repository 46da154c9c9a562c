# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The test's own place in the ROS graph: calls a node and listens to it."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
import time
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.executors import TimeoutException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

# A machine that is busy besides compiles shaders for minutes.
PATIENCE = 300.0
# Always the same: with another time than before, the executor begins with its first subscription
# again, and one that is always ready keeps the others from their turn.
TURN = 0.02
# Without a message, the queues of the subscriptions are empty.
QUIET = 3 * TURN
_ASK_AGAIN = 0.2  # [s]


class Watch:
    """
    The messages of one topic since the last clear.

    Those that nobody looks at are not taken apart: markers have hundreds of points and colours.
    """

    def __init__(self, kind: type) -> None:
        """Start empty."""
        self._kind = kind
        self._raw: list[bytes] = []
        self._messages: list[Any] = []

    def take(self, raw: bytes) -> None:
        """Take in a message as it came."""
        self._raw.append(raw)

    @property
    def messages(self) -> list[Any]:
        """Get the messages, in the order in which they came."""
        self._messages += [deserialize_message(raw, self._kind) for raw in self._raw]
        self._raw.clear()
        return self._messages

    def clear(self) -> None:
        """Forget the messages."""
        self._raw.clear()
        self._messages.clear()


class GraphClient:
    """A node of the test; a context manager."""

    def __init__(self) -> None:
        """Join the graph, in a context of its own."""
        self._context = Context()
        rclpy.init(context=self._context)
        self.node = Node('test_client', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Any] = {}
        self._subscriptions: list[Subscription] = []

    def __enter__(self) -> 'GraphClient':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    @contextmanager
    def passing(self) -> Iterator[None]:
        """
        Remove its service clients and subscriptions at the end of the block.

        Each turn asks all that there are, so that what is left of the tests before would make it
        ever slower.
        """
        clients, subscriptions = set(self._clients), len(self._subscriptions)
        try:
            yield
        finally:
            for name in self._clients.keys() - clients:
                self.node.destroy_client(self._clients.pop(name))
            for subscription in self._subscriptions[subscriptions:]:
                self.node.destroy_subscription(subscription)
            del self._subscriptions[subscriptions:]

    def spin_until(self, condition: Callable[[], Any], what: str) -> Any:
        """Return what ``condition`` returns as soon as that is true; fail after a long while."""
        deadline = time.monotonic() + PATIENCE
        while not (result := condition()):
            assert time.monotonic() < deadline, f'{what}: not within {PATIENCE} s'
            self._executor.spin_once(timeout_sec=TURN)
        return result

    def service(self, kind: type, name: str) -> Any:
        """Return the client of the service ``name``, as soon as that is offered."""
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        self.spin_until(self._clients[name].service_is_ready, f'{name} is offered')
        return self._clients[name]

    def call(self, kind: type, name: str, /, **fields: Any) -> Any:
        """Return the answer of the service ``name``."""
        future = self.service(kind, name).call_async(kind.Request(**fields))
        self.spin_until(future.done, f'{name} answers')
        return future.result()

    def call_until_answered(self, kind: type, name: str, /, **fields: Any) -> Any:
        """
        Return the answer of the service ``name`` to a request that may come several times.

        A node that does not know this client yet does what it asks, and its answer gets lost.
        """
        service = self.service(kind, name)
        futures: list[Any] = []

        def answer() -> Any:
            futures.append(service.call_async(kind.Request(**fields)))
            self.spin_for(_ASK_AGAIN)
            return next((future.result() for future in futures if future.done()), None)

        return self.spin_until(answer, f'{name} answers')

    def is_read(self, topic: str) -> bool:
        """Return whether a publisher of this node has a reader: it knows that after the graph."""
        return any(
            publisher.get_subscription_count() for publisher in self.node.publishers
            if publisher.topic_name == topic)

    def spin_for(self, seconds: float) -> None:
        """Take in what comes within ``seconds``."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._executor.spin_once(timeout_sec=TURN)

    def spin_until_quiet(self) -> None:
        """Take in what has come already: until nothing is left to be taken in for a while."""
        while True:
            begin = time.monotonic()
            try:
                handler, _, _ = self._executor.wait_for_ready_callbacks(timeout_sec=QUIET)
            except TimeoutException:
                if time.monotonic() - begin >= QUIET:
                    return
                # The time was over in a turn in which something came: more may be left.
                continue
            handler()
            handler.result()  # raises what the callback has raised

    def watch(self, kind: type, topic: str, *, depth: int = 1000, kept: bool = False) -> Watch:
        """Listen to ``topic``; ``kept`` asks for what was published before as well."""
        watch = Watch(kind)
        durability = DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE

        subscription = self.node.create_subscription(
            kind, topic, watch.take, QoSProfile(depth=depth, durability=durability), raw=True)
        self._subscriptions.append(subscription)
        self.spin_until(
            lambda: self.node.count_publishers(subscription.topic_name), f'{topic} is published')
        return watch

    def read_kept(self, kind: type, topic: str) -> Any:
        """Return what a subscriber of ``topic`` gets that came after it was published."""
        messages: list[Any] = []
        subscription = self.node.create_subscription(
            kind, topic, messages.append,
            QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.spin_until(lambda: messages, f'{topic} is kept')
        self.node.destroy_subscription(subscription)
        return messages[0]
