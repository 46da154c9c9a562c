# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The web server of a view."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextlib import redirect_stdout
import io
import socket

from cloth_sim_ros.sim.errors import ClothSimError
import viser

LOOPBACK = '127.0.0.1'


@contextmanager
def open_server(host: str, port: int) -> Iterator[viser.ViserServer]:
    """
    Serve a view at ``host`` and ``port``.

    :raises ClothSimError: when the address cannot be used
    """
    _check_free(host, port)
    # Viser greets and parts on stdout, which is for the result of a command.
    with redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=host, port=port, label='cloth_sim', verbose=False)
    try:
        # Sharing would hand the view to a server on the internet.
        server.gui.configure_theme(show_share_button=False, show_logo=False)
        server.scene.set_up_direction('+z')
        yield server
    finally:
        with redirect_stdout(io.StringIO()):
            server.stop()


def address(server: viser.ViserServer) -> str:
    """Return what to open in a browser on this machine."""
    host = server.get_host()
    shown = 'localhost' if host in ('0.0.0.0', '::') else host
    return f'http://{shown}:{server.get_port()}'


def _check_free(host: str, port: int) -> None:
    # Viser would go on to the next free port, which nobody asked for.
    if not 0 < port < 65536:
        raise ClothSimError(f'--port must be from 1 to 65535, got {port}')
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
    except OSError as error:
        raise ClothSimError(
            f'{host}:{port} cannot be served ({error.strerror or error}): give another --port or '
            '--host') from error
