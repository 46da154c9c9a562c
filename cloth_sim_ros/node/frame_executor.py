# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Wait for requests and events, at a cost that does not count."""

from collections.abc import Callable
from typing import Any

from rclpy.action import ActionServer
from rclpy.executors import ExternalShutdownException
from rclpy.executors import ShutdownException
from rclpy.executors import SingleThreadedExecutor
from rclpy.executors import TimeoutException
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.waitable import NumberOfEntities

_NANOSECONDS = 1e9
_FOR_EVER = -1
_GUARD = 'guard_condition'
# In the order in which a wait set counts them.
_KINDS = ('subscription', _GUARD, 'timer', 'client', 'service')


class FrameExecutor(SingleThreadedExecutor):
    """
    Serve one node.

    rclpy collects all entities of a node for each callback, and once more as each callback wakes
    the executor: 50 frames a second cost as much as a small cloth (docs/notes/performance.md).
    Here the list of entities is kept, and rclpy's executor only runs when there is something to
    serve. Guard conditions, by which frames come, are served without it. Events of publishers and
    subscriptions are served along with the next other thing.
    """

    # rclpy's __del__ reads it, also where a shutdown has kept __init__ from setting it.
    _sigint_gc: Any = None

    def __init__(self, node: Node) -> None:
        """Serve ``node``."""
        super().__init__(context=node.context)
        self.add_node(node)
        self._node = node
        assert node.context.handle is not None  # rclpy.init comes first
        self._context_handle = node.context.handle
        self._is_changed = True
        self._waited: list[tuple[Callable[[Any], Any], Any]] = []
        self._servers: list[ActionServer] = []
        self._wait_set: Any = None

    def wake(self) -> None:
        """End the wait; the node calls it when it has other entities than before."""
        self._is_changed = True
        super().wake()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Serve all that is ready, each once."""
        is_ready, triggered = self._wait(timeout_sec)
        for guard in triggered:
            guard.callback()
        # The rest is left for the next time.
        if is_ready or any(not task.done() for task, _, _ in self._tasks):
            self._serve()

    def _wait(self, seconds: float | None) -> tuple[bool, list[Any]]:
        """Return whether rclpy has something to serve within ``seconds``, and what triggered."""
        if self._is_changed:
            self._collect()
        wait_set = self._wait_set
        with wait_set, self._context_handle:
            # A wait leaves only what is ready in the set.
            wait_set.clear_entities()
            for add, handle in self._waited:
                add(handle)
            for server in self._servers:
                server.add_to_wait_set(wait_set)
            wait_set.wait(_FOR_EVER if seconds is None else int(seconds * _NANOSECONDS))
            if not self._context.ok():
                raise ExternalShutdownException
            guards = wait_set.get_ready_entities(_GUARD)
            is_ready = any(
                wait_set.get_ready_entities(kind) for kind in _KINDS if kind != _GUARD) or any(
                    server.is_ready(wait_set) for server in self._servers)
        # Its own guard only ends the wait: what waits then is a task, or other entities.
        return is_ready, [
            guard for guard in self._node.guards if guard.handle.pointer in guards]

    def _collect(self) -> None:
        """Collect the entities to wait for."""
        self._is_changed = False
        node = self._node
        waited: dict[str, list[Any]] = {
            kind: [entity for entity in entities if self.can_execute(entity)]
            for kind, entities in zip(_KINDS, (
                node.subscriptions, node.guards, node.timers, node.clients, node.services))}
        waited[_GUARD] += [self._guard, self._sigint_gc]
        self._servers = [
            each for each in node.waitables
            if isinstance(each, ActionServer) and self.can_execute(each)]
        counts = NumberOfEntities(*(len(waited[kind]) for kind in _KINDS))
        for server in self._servers:
            counts += server.get_num_entities()
        with self._context_handle:
            self._wait_set = _rclpy.WaitSet(
                counts.num_subscriptions, counts.num_guard_conditions, counts.num_timers,
                counts.num_clients, counts.num_services, counts.num_events, self._context_handle)
        self._waited = [
            (getattr(self._wait_set, f'add_{kind}'), entity.handle)
            for kind, entities in waited.items() for entity in entities]

    def _serve(self) -> None:
        while True:
            try:
                handler, _, _ = self.wait_for_ready_callbacks(0.0, None, _never)
            except (TimeoutException, ShutdownException):
                break
            handler()
            if handler.exception() is not None:
                raise handler.exception()
            handler.result()
        # What was taken in a callback can be waited for again, and callbacks make new entities.
        self._is_changed = True


def _never() -> bool:
    return False
