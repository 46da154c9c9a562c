# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who may open a page: requests for this view by its own name, from its own page, with its key."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
import hmac
from http import HTTPStatus
import ipaddress
import logging
import secrets
import socket
from threading import Lock
from typing import Any
from urllib.parse import urlsplit

from cloth_sim_ros.sim.errors import ClothSimError
import viser
import websockets.asyncio.server as websocket_server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request
from websockets.http11 import Response

# Random bytes in the address of a page: 128 bits, which nobody guesses.
_TOKEN_BYTES = 16
# Max. size of a message from a page [bytes]; a page sends some 300, and viser would take 50 MiB.
_MOST_RECEIVED = 64 << 10
_LOCAL_NAMES = frozenset({'localhost', '127.0.0.1', '::1'})
_ANY_ADDRESS = frozenset({'0.0.0.0', '::', ''})
_patching = Lock()

# Responds to a request; None lets it become a websocket.
Answer = Callable[[ServerConnection, Request], Response | None]


class Door:
    """
    Check each request for a page or a websocket before viser sees it.

    The token is the path of the page's address. The page opens its websocket below the same path.
    ``Host`` has to be a name of this view, so that a web site cannot have its own name lead here
    (DNS rebinding). ``Origin``, which browsers send with each websocket, has to be that same host.

    :param host: that the view is served on
    """

    def __init__(self, host: str) -> None:
        """Choose a token."""
        self.token = secrets.token_urlsafe(_TOKEN_BYTES)
        self._names = {host.lower()} - _ANY_ADDRESS | _LOCAL_NAMES
        if host in _ANY_ADDRESS:
            name = socket.gethostname().lower()
            self._names |= {name, f'{name}.local'}

    def refusal(self, request: Request, served_on: str) -> str:
        """
        Return why ``request`` is refused, with the way out; empty when it may enter.

        :param served_on: address of this machine that the request came to
        """
        host = _only(request, 'Host')
        name = _host_name(host)
        if name is None or not (name in self._names or _same_address(name, served_on)):
            return (
                'the Host of the request is not a name of this view: open the address that '
                '`cloth_sim view` has printed, or give the name with --host')
        if request.headers.get_all('Origin') and (
                _only(request, 'Origin').lower() != f'http://{host.lower()}'):
            return (
                'the request comes from the page of another web site: open the address that '
                '`cloth_sim view` has printed')
        if not self._has_token(request.path):
            return (
                'the address lacks the key of this view: open the whole address that '
                '`cloth_sim view` has printed')
        return ''

    def _has_token(self, path: str) -> bool:
        given = path.partition('?')[0].split('/')[1:2]
        # In a time that does not depend on how much of it is right.
        return bool(given) and hmac.compare_digest(
            given[0].encode(errors='replace'), self.token.encode())

    def without_token(self, path: str) -> str:
        """Return ``path`` as viser knows it."""
        return path[1 + len(self.token):] or '/'

    @contextmanager
    def guard(
            self, connect: Callable[..., ServerConnection], logger: logging.Logger,
            complain: Callable[[str, str], None]) -> Iterator[None]:
        """
        Let the server that viser starts meanwhile ask this door.

        viser has no setting for this: it passes its own ``process_request`` to websockets.

        :param connect: makes the connections
        :param logger: for what websockets reports
        :param complain: is given a kind of complaint and the text of each request refused
        :raises ClothSimError: when viser has started a server in another way
        """
        serve, guarded = websocket_server.serve, []

        def serve_guarded(handler: Any, *args: Any, **options: Any) -> Any:
            if not getattr(handler, '__module__', '').startswith('viser.'):
                return serve(handler, *args, **options)
            guarded.append(handler)
            options.update(
                process_request=self._asked_first(options.get('process_request'), complain),
                create_connection=connect, logger=logger, max_size=_MOST_RECEIVED)
            return serve(handler, *args, **options)

        with _patching:
            websocket_server.serve = serve_guarded  # type: ignore[assignment, misc]
            try:
                yield
            finally:
                websocket_server.serve = serve  # type: ignore[misc]
        if not guarded:
            raise ClothSimError(
                f'viser {viser.__version__} cannot be served with a key: install the version of '
                'requirements/view.txt, with `./scripts/setup.sh --view`')

    def _asked_first(
            self, serve_page: Answer | None, complain: Callable[[str, str], None]) -> Answer:
        def answer(connection: ServerConnection, request: Request) -> Response | None:
            refused = self.refusal(request, connection.local_address[0])
            if refused:
                peer = connection.remote_address[0]
                complain('refused', f'refused a request from {peer}: {refused}')
                return connection.respond(HTTPStatus.FORBIDDEN, f'cloth_sim view: {refused}\n')
            request.path = self.without_token(request.path)
            response = serve_page(connection, request) if serve_page is not None else None
            if response is not None:
                # The key would go with the address to whatever the page links to.
                response.headers['Referrer-Policy'] = 'no-referrer'
            return response
        return answer


def _only(request: Request, header: str) -> str:
    values = request.headers.get_all(header)
    return values[0] if len(values) == 1 else ''


def _host_name(host: str) -> str | None:
    """Return the name in a Host header, without its port; None where there is none."""
    try:
        parts = urlsplit(f'//{host}')
        _ = parts.port
    except ValueError:
        return None
    return parts.hostname if parts.netloc == host and '@' not in host else None


def _same_address(name: str, address: str) -> bool:
    try:
        named, own = ipaddress.ip_address(name), ipaddress.ip_address(address.partition('%')[0])
    except ValueError:
        return False
    # An IPv6 socket shows IPv4 addresses in its own notation.
    return named in (own, getattr(own, 'ipv4_mapped', None))
