# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A live view that is served to pages, refreshed by a thread of its own."""

from collections.abc import Iterator
from contextlib import contextmanager
import random
import socket
from threading import Event
from threading import Thread

from cloth_sim_ros.view.server import LOOPBACK
from cloth_sim_ros.view.server import open_server
from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.window import Window

# Above those of services that have one of their own, and below those for outgoing connections.
PORTS = range(20_000, 32_000)


def free_port() -> int:
    """
    Return a port that nobody listens on.

    It is not one of those that the system gives to whoever connects somewhere: such a one may be
    gone again before it is used.
    """
    for port in random.SystemRandom().sample(PORTS, len(PORTS)):
        with socket.socket() as probe:
            try:
                probe.bind((LOOPBACK, port))
            except OSError:
                continue
            return port
    raise RuntimeError(f'all ports from {PORTS[0]} to {PORTS[-1]} are in use')


@contextmanager
def served(source: Source) -> Iterator[str]:
    """Serve a view of ``source`` and yield its address; the source is closed at the end."""
    ended = Event()
    with open_server(LOOPBACK, free_port()) as server:
        window = Window(server, source)

        def refresh() -> None:
            while not ended.wait(0.03):
                window.refresh()

        thread = Thread(target=refresh)
        thread.start()
        try:
            yield server.address
        finally:
            ended.set()
            thread.join()
            source.close()
