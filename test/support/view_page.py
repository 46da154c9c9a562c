# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page of the live view without a browser: it speaks the viewer's protocol over a websocket."""

from collections.abc import Callable
import time
from typing import Any

import msgspec.msgpack
import numpy as np
import viser
from websockets.sync.client import connect
import zstandard

PATIENCE = 300.0


class ViewPage:
    """
    Keep what a page would show, and send what its user would do; a context manager.

    ``nodes`` holds the props, the place and the visibility of each node of the scene by its name,
    ``told`` the notifications.

    :param address: of the view, as it is printed
    :param headers: that a browser would send, such as Origin
    """

    def __init__(self, address: str, headers: dict[str, str] | None = None) -> None:
        """Connect, as a page does that was just opened."""
        self.nodes: dict[str, dict[str, Any]] = {}
        self.told: list[dict[str, Any]] = []
        self._by_uuid: dict[str, dict[str, Any]] = {}
        self._socket = connect(
            address.replace('http://', 'ws://'), additional_headers=headers,
            subprotocols=[f'viser-v{viser.__version__}'], max_size=None, compression=None,
            open_timeout=PATIENCE)
        # The server takes a page for open when it has told of its camera.
        self.send(
            'ViewerCameraMessage', wxyz=(1.0, 0.0, 0.0, 0.0), position=(0.0, 0.0, 5.0), fov=1.0,
            near=0.01, far=100.0, image_height=400, image_width=600, look_at=(0.0, 0.0, 0.0),
            up_direction=(0.0, 0.0, 1.0))

    def __enter__(self) -> 'ViewPage':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the page."""
        self._socket.close()

    @property
    def controls(self) -> dict[str, dict[str, Any]]:
        """Get the controls by the labels they have now."""
        return {
            control['label']: control for control in self._by_uuid.values()
            if control.get('label')}

    @property
    def text(self) -> str:
        """Get the text above the controls."""
        return next(
            (control['_markdown'] for control in self._by_uuid.values() if '_markdown' in control),
            '')

    def wait_for(self, condition: Callable[[], Any], what: str) -> Any:
        """Take what the server sends until ``condition`` is true, and return that."""
        deadline = time.monotonic() + PATIENCE
        while not (found := condition()):
            assert time.monotonic() < deadline, f'the page never had {what}: {self.text}'
            try:
                self._take(self._socket.recv(timeout=0.2))
            except TimeoutError:
                pass
        return found

    def click(self, origin: tuple[float, ...], direction: tuple[float, ...]) -> None:
        """Click where a ray from the camera goes."""
        self.send(
            'ScenePointerMessage', event_type='click', ray_origin=origin,
            ray_direction=direction, screen_pos=((0.5, 0.5),), modifier=None)

    def give(self, label: str, value: Any) -> None:
        """Give the control ``label`` another value; True presses a button."""
        self.send('GuiUpdateMessage', uuid=self.controls[label]['uuid'], updates={'value': value})

    def drag(self, name: str, position: tuple[float, ...]) -> None:
        """Take the handle ``name`` to ``position`` and let it go."""
        self.send('TransformControlsDragStartMessage', name=name, owner='')
        self.send('TransformControlsUpdateMessage', name=name, wxyz=(1.0, 0.0, 0.0, 0.0),
                  position=position, owner='')
        self.send('TransformControlsDragEndMessage', name=name, owner='')

    def send(self, kind: str, **fields: Any) -> None:
        """Send a message of viser's protocol."""
        self.send_data(msgspec.msgpack.encode({'type': kind, **fields}))

    def send_data(self, data: bytes | str) -> None:
        """Send bytes or a text, whatever it is."""
        self._socket.send(data)

    def points(self) -> np.ndarray:
        """Return the vertices of all meshes that are shown, (n, 3) [m]."""
        return np.concatenate([
            node['vertices'].reshape(-1, 3) for name, node in self.nodes.items()
            if name.startswith('/cloth/strain_') and node['visible']])

    def dots(self, name: str) -> np.ndarray:
        """Return the points of a cloud, (n, 3) [m]."""
        return self.nodes[name]['points'].reshape(-1, 3)

    def _take(self, data: bytes) -> None:
        size = int.from_bytes(data[8:16], 'little')
        window = msgspec.msgpack.decode(zstandard.decompress(data[16:16 + size]))
        arrays, begin = [], 16 + size
        for length in window['binaryBufferLengths']:
            begin += -begin % 8
            arrays.append(data[begin:begin + length])
            begin += length
        for message in window['messages']:
            self._show(_with_arrays(message, arrays))

    def _show(self, message: dict[str, Any]) -> None:
        kind, name = message['type'], message.get('name')
        if kind == 'NotificationShowMessage':
            self.told.append(message)
        elif kind == 'RemoveSceneNodeMessage':
            self.nodes.pop(name, None)
        elif kind == 'SceneNodeUpdateMessage':
            self.nodes[name].update(message['updates'])
        elif kind == 'SetPositionMessage':
            self.nodes[name]['position'] = message['position']
        elif kind == 'SetOrientationMessage' and name in self.nodes:
            self.nodes[name]['wxyz'] = message['wxyz']
        elif kind == 'SetSceneNodeVisibilityMessage':
            self.nodes[name]['visible'] = message['visible']
        elif kind == 'GuiUpdateMessage':
            self._by_uuid[message['uuid']].update(message['updates'])
        elif kind.startswith('Gui') and 'props' in message:
            self._by_uuid[message['uuid']] = {
                **message['props'], 'uuid': message['uuid'], 'value': message.get('value')}
        elif name is not None and 'props' in message:
            self.nodes[name] = {
                'visible': True, 'position': (0.0, 0.0, 0.0), **message['props']}


def _with_arrays(value: Any, arrays: list[bytes]) -> Any:
    if isinstance(value, list):
        return [_with_arrays(part, arrays) for part in value]
    if not isinstance(value, dict):
        return value
    if '__binary_index' in value:
        return np.frombuffer(arrays[value['__binary_index']], value['dtype'])
    return {key: _with_arrays(part, arrays) for key, part in value.items()}
