# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A live view that is served to pages, refreshed by a thread of its own."""

from collections.abc import Iterator
from contextlib import contextmanager
import socket
from threading import Event
from threading import Thread

from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.window import LOOPBACK
from cloth_sim_ros.view.window import open_server
from cloth_sim_ros.view.window import Window


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        return probe.getsockname()[1]


@contextmanager
def served(source: Source) -> Iterator[int]:
    """Serve a view of ``source`` and yield its port; the source is closed at the end."""
    port, ended = free_port(), Event()
    with open_server(LOOPBACK, port) as server:
        window = Window(server, source)

        def refresh() -> None:
            while not ended.wait(0.03):
                window.refresh()

        thread = Thread(target=refresh)
        thread.start()
        try:
            yield port
        finally:
            ended.set()
            thread.join()
            source.close()
