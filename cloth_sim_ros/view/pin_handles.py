# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Handles by which pins are dragged."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.view.source import Source
import numpy as np
import viser

# More would hide the cloth; other pins are dots.
MOST_HANDLES = 16
# Of the diagonal of the cloth.
_SIZE = 0.12

Node = tuple[int, int]


class PinHandles:
    """
    A set of arrows at each pin.

    :param answer: does an action for a page, and tells it what is wrong
    """

    def __init__(
            self, server: viser.ViserServer, source: Source,
            answer: Callable[[Any, Callable[[], Any]], None]) -> None:
        """Begin without pins."""
        self._scene = server.scene
        self._source = source
        self._answer = answer
        self._handles: dict[Node, viser.TransformControlsHandle] = {}
        # Those in somebody's hand: they lead their pins, and do not follow them.
        self._dragged: set[Node] = set()

    def follow(self, frame: Frame, is_shown: bool) -> None:
        """Put a handle at each of the first pins, and none elsewhere."""
        pins = [(int(row), int(col)) for row, col in np.argwhere(frame.pinned)[:MOST_HANDLES]]
        wanted = set(pins) if is_shown else set()
        for node in self._handles.keys() - wanted:
            self._handles.pop(node).remove()
            self._dragged.discard(node)
        positions = frame.positions
        for node in pins if is_shown else ():
            if node not in self._handles:
                extent = np.linalg.norm(np.ptp(positions.reshape(-1, 3), axis=0))
                self._handles[node] = self._add(node, _SIZE * float(extent))
            handle = self._handles[node]
            if node not in self._dragged and not np.array_equal(handle.position, positions[node]):
                handle.position = positions[node]

    def _add(self, node: Node, size: float) -> viser.TransformControlsHandle:
        handle = self._scene.add_transform_controls(
            f'/handles/{node[0]}_{node[1]}', scale=size, disable_rotations=True,
            depth_test=False)

        @handle.on_update
        def _(event: viser.TransformControlsEvent) -> None:
            if event.phase == 'start':
                self._dragged.add(node)
            elif event.phase == 'end':
                self._dragged.discard(node)
            else:
                target = tuple(float(part) for part in event.target.position)
                self._answer(event.client, lambda: self._source.move_pin(*node, target))

        return handle
