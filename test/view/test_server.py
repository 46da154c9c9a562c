# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page of a view is for this machine, at the port that was asked for."""

import socket

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.view.server import LOOPBACK
from cloth_sim_ros.view.server import open_server
import pytest
from served_view import free_port


def test_it_listens_on_loopback_alone(capfd):
    """Whoever reaches the machine could steer the cloth, or stdout hold what no result is."""
    port = free_port()
    with open_server(LOOPBACK, port) as server:
        assert server.address.startswith(f'http://127.0.0.1:{port}/')
        socket.create_connection((LOOPBACK, port), 10.0).close()
        # Another address of this machine, as one of the network is.
        with pytest.raises(OSError):
            socket.create_connection(('127.0.0.2', port), 10.0)
    assert capfd.readouterr().out == ''


def test_a_port_in_use_is_refused():
    """The view would be at another port than the one that was asked for."""
    with socket.socket() as other:
        other.bind((LOOPBACK, 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(ClothSimError, match=f'{port} cannot be served .*another --port'):
            open_server(LOOPBACK, port).__enter__()


@pytest.mark.parametrize('port', [0, 65536, -1])
def test_a_port_that_is_none_is_refused(port: int):
    """The view would be at a port that nobody knows, or end in a traceback."""
    with pytest.raises(ClothSimError, match='--port must be from 1 to 65535'):
        open_server(LOOPBACK, port).__enter__()
