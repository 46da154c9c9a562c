# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The moving pins of many cloths, all moved at once."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.model.pins import path_velocities
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Invocations of a workgroup of place_pins.comp [1].
_LOCAL = 32
# Rounding of the end of a path, in steps of dt [1].
_NOTHING = 1e-9
_PIN = np.dtype([
    ('position', np.float32, 4), ('velocity', np.float32, 3), ('index', np.int32)])
_PATH = np.dtype([
    ('row', int), ('col', int), ('origin', float, 3), ('target', float, 3),
    ('velocity', float, 3), ('first', int), ('begin', float), ('arrival', float)])


class StackedPins:
    """
    Moves pins as PinMotion does, to the bit, in one pass for all of them.

    Each move is timed by the clock of its cloth, which has begun with a step ``first``.

    :param layout: of the stack that the pins are in
    """

    def __init__(self, scene: Scene, layout: Layout, state: State) -> None:
        """Begin with all pins at rest; nothing is compiled yet."""
        self._dt: float = scene['dt']
        self._layout = layout
        self._state = state
        self._paths = np.empty(0, dtype=_PATH)
        # Velocities of the present step.
        self._latest: np.ndarray = np.empty((0, 3))
        self._program = SceneProgram('place_pins.comp', scene, layout, {'PINS_LOCAL': _LOCAL})
        self._buffer: Buffer | None = None

    @property
    def rest(self) -> bool:
        """Return whether no pin is under way."""
        return not len(self._paths)

    def move(
            self, nodes: np.ndarray, targets: np.ndarray, speeds: np.ndarray,
            firsts: np.ndarray, number: int) -> None:
        """
        Begin to move pins before step ``number``, each instead of its move in progress.

        :param nodes: row in the stack and col of each, (n, 2) int, each once
        :param targets: (n, 3) [m]
        :param speeds: (n,) [m/s]
        :param firsts: number of the first step of the cloth of each, (n,) int
        """
        paths = np.empty(len(nodes), dtype=_PATH)
        paths['row'], paths['col'] = nodes.T
        origins = self._state.read_positions()[tuple(nodes.T)].astype(float)
        now = (number - firsts) * self._dt
        before, where = self._under_way(nodes)
        origins[where] = _positions(self._paths[before], now[where])
        velocities, durations = path_velocities(origins, targets, speeds)
        paths['origin'], paths['target'], paths['velocity'] = origins, targets, velocities
        paths['first'] = firsts
        paths['begin'], paths['arrival'] = now, now + durations
        self._paths = np.concatenate([np.delete(self._paths, before), paths])

    def stop(self, rows: slice) -> None:
        """Forget the moves of pins in ``rows`` of the stack, which are at rest again."""
        row = self._paths['row']
        self._paths = self._paths[(row < rows.start) | (row >= rows.stop)]

    def hold(self, nodes: np.ndarray) -> None:
        """Pin ``nodes`` of the stack (n, 2) where they are; moving pins stop."""
        stopped = self._forget(nodes)
        for row, col in nodes.tolist():
            self._state.set_pinned(row, col, True)
        for row, col in stopped.tolist():
            self._state.set_pin_velocity(row, col, np.zeros(3))

    def release(self, nodes: np.ndarray) -> None:
        """Let ``nodes`` of the stack (n, 2) go, with the velocities of their pins."""
        self._forget(nodes)
        for row, col in nodes.tolist():
            self._state.set_pinned(row, col, False)

    def begin_step(self, number: int) -> None:
        """Give the moving pins their velocities in step ``number``."""
        if self.rest:
            return
        paths = self._paths
        begin, end = self._span(number)
        here = _positions(paths, begin)
        velocities = paths['velocity'].copy()
        # On the way the velocity has the same bits in each step.
        ends = ~((paths['begin'] <= begin) & (end <= paths['arrival']))
        velocities[ends] = (_positions(paths[ends], end[ends]) - here[ends]) / (
            end - begin)[ends, None]
        self._latest = velocities
        self._place(here, velocities)

    def end_step(self, number: int) -> None:
        """Put the pins where step ``number`` ends; those at their target come to rest."""
        if self.rest:
            return
        paths = self._paths
        begin, end = self._span(number)
        arrive = paths['arrival'] <= end + _NOTHING * (end - begin)
        there = np.where(arrive[:, None], paths['target'], _positions(paths, end))
        self._place(there, np.where(arrive[:, None], 0.0, self._latest))
        self._paths = paths[~arrive]

    def delete(self) -> None:
        """Release pass and buffer."""
        self._program.delete()
        if self._buffer is not None:
            self._buffer.delete()

    def _span(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        """Return when step ``number`` begins and ends by the clock of each path, (n,) [s]."""
        own = number - self._paths['first']
        return own * self._dt, (own + 1) * self._dt

    def _forget(self, nodes: np.ndarray) -> np.ndarray:
        """Forget the moves of ``nodes``, and return which of them moved, (k, 2)."""
        before, where = self._under_way(nodes)
        self._paths = np.delete(self._paths, before)
        return nodes[where]

    def _under_way(self, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the places of paths that ``nodes`` are on, and those in ``nodes``."""
        cols = self._layout.cols
        _, before, where = np.intersect1d(
            self._paths['row'] * cols + self._paths['col'], nodes[:, 0] * cols + nodes[:, 1],
            return_indices=True)
        return before, where

    def _place(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        pins = np.zeros(len(positions), dtype=_PIN)
        pins['position'][:, :3] = positions
        pins['velocity'] = velocities
        pins['index'] = self._layout.index(0, 0) + (
            self._paths['row'] * self._layout.pitch + self._paths['col'])
        if self._buffer is None or self._buffer.bytes < pins.nbytes:
            if self._buffer is not None:
                self._buffer.delete()
            self._buffer = Buffer(pins)
        else:
            self._buffer.write(pins)
        program = self._program.use()
        program.set_int('count', len(pins))
        self._state.bind_for_changes()
        self._buffer.bind_storage(bindings.MOVED_PINS)
        program.dispatch(-(-len(pins) // _LOCAL))
        shader_writes_visible()


def _positions(paths: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Return where pins on ``paths`` are at ``time`` (n,) [s], (n, 3) [m]."""
    passed = np.maximum(time - paths['begin'], 0.0)[:, None]
    on_the_way = paths['origin'] + paths['velocity'] * passed
    return np.where((time >= paths['arrival'])[:, None], paths['target'], on_the_way)
