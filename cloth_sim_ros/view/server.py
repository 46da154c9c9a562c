# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The server of a view: for those who have its address, and not ended by any of them."""

import asyncio
from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from contextlib import redirect_stdout
import io
import logging
import socket
import sys
import time
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.view.door import Door
from cloth_sim_ros.view.received import problem_of
import viser
from viser import _messages
from websockets.asyncio.server import ServerConnection

LOOPBACK = '127.0.0.1'
# Min. time between two printed warnings of one kind [s].
_QUIET = 10.0
# What a browser causes that opens a connection in advance and does not use it.
_ORDINARY = 'opening handshake failed'


class Complaints:
    """Print faults of requests from outside on stderr, not too often."""

    def __init__(self) -> None:
        """Begin with none."""
        self._told: dict[str, float] = {}
        self._left_out: dict[str, int] = {}

    def tell(self, kind: str, text: str) -> None:
        """Print ``text``, unless another complaint of this ``kind`` was printed just before."""
        now = time.monotonic()
        if now < self._told.get(kind, -_QUIET) + _QUIET:
            self._left_out[kind] = self._left_out.get(kind, 0) + 1
            return
        self._told[kind] = now
        missed = self._left_out.pop(kind, 0)
        more = f' (and {missed} more before this)' if missed else ''
        print(f'cloth_sim view: {text}{more}', file=sys.stderr, flush=True)

    def fault(self, error: BaseException, where: str) -> str:
        """Print an unexpected error in one line, and return it."""
        trace = error.__traceback__
        while trace is not None and trace.tb_next is not None:
            trace = trace.tb_next
        place = f' at {trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}' if trace else ''
        text = f'{where} failed unexpectedly: {type(error).__name__}, {cut(error)}{place}'
        self.tell(where, f'{text}; the view goes on: report it')
        return text


class _Log(logging.Handler):
    """Passes on what websockets reports of connections, in one line without a trace."""

    def __init__(self, complaints: Complaints) -> None:
        super().__init__(logging.WARNING)
        self._complaints = complaints

    def emit(self, record: logging.LogRecord) -> None:
        if record.getMessage() != _ORDINARY:
            error = record.exc_info[1] if record.exc_info else None
            reason = f' ({type(error).__name__} {cut(error)})' if error is not None else ''
            self._complaints.tell('connection', f'{record.getMessage()}{reason}')


class _PageConnection(ServerConnection):
    """The websocket of a page, which drops messages that viser could not use."""

    def __init__(self, *args: Any, server_of_view: 'ViewServer', **options: Any) -> None:
        super().__init__(*args, **options)
        self._view = server_of_view
        self._has_complained = False

    async def recv(self, decode: bool | None = None) -> Any:
        while True:
            data = await super().recv(decode)
            problem = problem_of(data, self._view.control)
            if not problem:
                return data
            if not self._has_complained:
                self._has_complained = True
                # Meanwhile viser handles the page's first message, and so knows the page.
                await asyncio.sleep(0.0)
                self._view.tell_page(self, problem)


class ViewServer(viser.ViserServer):
    """
    Serve pages to those who have ``address``.

    :param host: to serve on
    :param port: to serve on
    """

    def __init__(self, host: str, port: int) -> None:
        """Begin to serve."""
        self.complaints = Complaints()
        self.door = Door(host)
        logger = logging.Logger('cloth_sim_ros.view', logging.WARNING)
        logger.addHandler(_Log(self.complaints))
        with self.door.guard(self._new_connection, logger, self.complaints.tell):
            super().__init__(host=host, port=port, label='cloth_sim', verbose=False)
        # A request for it would start a tunnel by which anyone on the internet can open the view.
        for kind in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
            self._websock_server.unregister_handler(kind)
        self.gui.configure_theme(show_share_button=False, show_logo=False)
        self.scene.set_up_direction('+z')
        self._event_loop.set_exception_handler(self._on_fault)

    @property
    def address(self) -> str:
        """Get what to open in a browser on this machine."""
        host = self.get_host()
        shown = 'localhost' if host in ('0.0.0.0', '::') else host
        shown = f'[{shown}]' if ':' in shown else shown
        return f'http://{shown}:{self.get_port()}/{self.door.token}'

    def control(self, uuid: str) -> Any:
        """Return viser's handle of a control; None where there is none."""
        return self.gui._gui_input_handle_from_uuid.get(uuid)

    def tell_page(self, connection: ServerConnection, problem: str) -> None:
        """Say what was wrong with the first message of a page that had to be dropped."""
        text = f'dropped {problem}: reload the page, if it is one of this view'
        self.complaints.tell('message', f'a page sent what cannot be used: {text}')
        for number, other in list(self._websock_server._live_connections.items()):
            client = self.get_clients().get(number) if other is connection else None
            if client is not None:
                tell(client, text)

    def _new_connection(self, *args: Any, **options: Any) -> ServerConnection:
        return _PageConnection(*args, server_of_view=self, **options)

    def _on_fault(self, _: object, context: dict[str, Any]) -> None:
        error = context.get('exception')
        if error is not None:
            self.complaints.fault(error, 'a message from a page')


def tell(client: viser.ClientHandle, text: str) -> None:
    """Show ``text`` on the page of ``client``."""
    client.add_notification('That cannot be done', text, color='red', auto_close_seconds=10.0)


def do_for(
        server: ViewServer, client: viser.ClientHandle | None,
        action: Callable[[], Any]) -> None:
    """Do ``action``; report errors on the page of ``client``, which asked."""
    try:
        action()
    except ClothSimError as error:
        text = str(error)
    except Exception as error:
        # The next request, of this page or another, has nothing to do with it.
        text = server.complaints.fault(error, 'a request of a page')
    else:
        return
    if client is not None:
        tell(client, text)


@contextmanager
def open_server(host: str, port: int) -> Iterator[ViewServer]:
    """
    Serve a view at ``host`` and ``port``.

    :raises ClothSimError: when the address cannot be used
    """
    _check_free(host, port)
    # Viser greets and parts on stdout, which is for the result of a command.
    with redirect_stdout(io.StringIO()):
        server = ViewServer(host, port)
    try:
        yield server
    finally:
        with redirect_stdout(io.StringIO()):
            server.stop()


def _check_free(host: str, port: int) -> None:
    # Viser would go on to the next free port, which nobody requested.
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
