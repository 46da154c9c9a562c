# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The data of a recorded run, read in one pass."""

from collections import Counter
from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Mapping

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.frame_table import FrameTable
from cloth_sim_ros.analysis.frame_table import STATS
from cloth_sim_ros.analysis.frame_table import StrainHistogram
from cloth_sim_ros.analysis.input_history import MODE_KEYS as MODE_KEYS
from cloth_sim_ros.analysis.input_history import ModeHistory
from cloth_sim_ros.analysis.input_history import PUSH_KEYS as PUSH_KEYS
from cloth_sim_ros.analysis.input_history import PushHistory
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.frame_names import name_of_body
from cloth_sim_ros.messages.frame_names import node_of_pin
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
import numpy as np

KEY = 'pins/wrenches'
SUM = ('pin_force_x', 'pin_force_y', 'pin_force_z')
LARGEST = 'largest_pin_force'
MOST_PINS = 16

Node = tuple[int, int]


class PinColumns:
    """Collects the force of the cloth on each holder [N], moment by moment."""

    def __init__(self) -> None:
        """Begin without forces."""
        self._forces: dict[tuple[int, float], dict[Node, tuple[float, float, float]]] = {}

    def read(self, entry: Entry) -> None:
        """Take a message of ~/pins/wrenches; that of no pin is passed over."""
        node = node_of_pin(entry.message.header.frame_id)
        if node is not None:
            force = entry.message.wrench.force
            self._forces.setdefault((entry.resets, entry.time), {})[node] = (
                force.x, force.y, force.z)

    def columns(self, moments: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """
        Return the sum of all pins, the largest, and each pin where there are MOST_PINS or fewer.

        A value is nan where nothing was recorded. The columns of the pin (r, c) are
        ``pin_r_c_force_x`` and so on.

        :param moments: columns ``time`` and ``resets`` of the table
        """
        nodes = sorted({node for forces in self._forces.values() for node in forces})
        shown = nodes if len(nodes) <= MOST_PINS else []
        places = {node: 4 + 3 * number for number, node in enumerate(shown)}
        values = np.full((len(moments['time']), 4 + 3 * len(shown)), np.nan)
        for row, moment in enumerate(zip(moments['resets'].tolist(), moments['time'].tolist())):
            forces = self._forces.get(moment, {})
            if forces:
                vectors = np.array(list(forces.values()))
                values[row, :3] = vectors.sum(axis=0)
                values[row, 3] = np.linalg.norm(vectors, axis=1).max()
            for node in places.keys() & forces.keys():
                values[row, places[node]:places[node] + 3] = forces[node]
        names = [*SUM, LARGEST, *(
            f'pin_{row}_{col}_force_{axis}' for row, col in shown for axis in 'xyz')]
        return dict(zip(names, values.T.copy()))


BODY_KEYS = {'grasps/wrenches': 'grasp', 'colliders/wrenches': 'collider'}


class BodyColumns:
    """Collects the force of the cloth on each grasp and collider [N], in the axes of its frame."""

    def __init__(self) -> None:
        """Begin without forces."""
        self._forces: dict[str, dict[tuple[int, float], tuple[float, float, float]]] = {}

    def read(self, entry: Entry) -> None:
        """Take a message of one of BODY_KEYS."""
        kind = BODY_KEYS[entry.key]
        name = name_of_body(entry.message.header.frame_id, kind)
        if name:
            force = entry.message.wrench.force
            self._forces.setdefault(f'{kind}_{name}', {})[entry.resets, entry.time] = (
                force.x, force.y, force.z)

    def times(self, kind: str) -> dict[str, tuple[float, float]]:
        """Return the times of the first and last message of each body [s], by its name."""
        return {
            body.removeprefix(f'{kind}_'): (
                min(time for _, time in forces), max(time for _, time in forces))
            for body, forces in self._forces.items() if body.startswith(f'{kind}_')}

    def columns(self, moments: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return ``grasp_NAME_force_x``, ``collider_NAME_force_x`` ..., nan where unknown."""
        columns: dict[str, np.ndarray] = {}
        at = list(zip(moments['resets'].tolist(), moments['time'].tolist()))
        unknown = (np.nan,) * 3
        for body, forces in sorted(self._forces.items()):
            values = np.array([forces.get(moment, unknown) for moment in at]).reshape(-1, 3)
            columns.update(
                (f'{body}_force_{axis}', part) for axis, part in zip('xyz', values.T.copy()))
        return columns


# ClothState.STOPPED: a recording is read without the interfaces.
_STOPPED = 'stopped'
_FIGURES = ('points', 'stats')
KEYS = (
    *_FIGURES, KEY, *BODY_KEYS, 'state', 'inputs/mode', 'inputs/pin', 'inputs/grasp', *PUSH_KEYS)

# Without a message on another topic nothing was done to the cloth.
_TELLING = (*_FIGURES, 'state', 'inputs/mode')

Watch = Callable[[Iterable[Entry], int], Iterable[Entry]]


def not_watched(entries: Iterable[Entry], _: int) -> Iterator[Entry]:
    """Hand the entries on."""
    return iter(entries)


class Run:
    """
    A run as recorded; a few hundred bytes a frame are kept.

    :param watch: is given all entries and their number, and hands them on: a progress bar
    :raises ClothSimError: when it holds neither points nor stats, or points of several cloths
    """

    def __init__(self, recording: Recording, watch: Watch = not_watched) -> None:
        """Read the recording."""
        self.path = recording.path
        self.name = recording.name
        self.node = recording.node
        self.device = ''
        self.rows = 0
        self.cols = 0
        self.stopped = False
        self.counts: Counter[str] = Counter()
        self.strains = StrainHistogram()
        self.missing = [key for key in _TELLING if key not in recording.keys()]
        self._unusable = ''
        self._has_points = False
        self._without: set[str] = set()
        self._pushes = PushHistory()
        self._modes = ModeHistory()
        self._table = FrameTable()
        self._pins = PinColumns()
        self._bodies = BodyColumns()
        self._grasps: dict[str, tuple[float, float]] = {}
        for entry in watch(recording.entries(*KEYS), recording.count(*KEYS)):
            self._read(entry)
        if not len(self._table):
            raise ClothSimError(self._unusable) if self._unusable else recording.no_frame()
        self.columns = self._table.columns()
        self.columns.update(self._pins.columns(self.columns))
        self.columns.update(self._bodies.columns(self.columns))
        self.is_whole = not recording.problems
        self.problems = [*recording.problems, *self._said()]

    @property
    def modes(self) -> ModeHistory:
        """Get the modes and their switches."""
        return self._modes

    @property
    def pushes(self) -> list[Push]:
        """Get the pushes, with ``start`` in the time of the recording."""
        return self._pushes.pushes

    @property
    def grasps(self) -> dict[str, tuple[float, float]]:
        """Get when each grasp has held nodes first and last [s], as far as it was recorded."""
        spans = self._bodies.times('grasp')
        for name, (begin, end) in self._grasps.items():
            first, last = spans.get(name, (begin, end))
            spans[name] = min(first, begin), max(last, end)
        return spans

    def has(self, column: str) -> bool:
        """Return whether any frame has a figure in ``column``."""
        return bool(np.isfinite(self.columns[column]).any())

    def _read(self, entry: Entry) -> None:
        key, message = entry.key, entry.message
        if key == 'points':
            self._read_points(entry)
        elif key == 'stats':
            self._read_stats(entry)
        elif key == KEY:
            self._pins.read(entry)
        elif key in BODY_KEYS:
            self._bodies.read(entry)
        elif key == 'inputs/grasp':
            self._read_grasp(entry)
        elif key in PUSH_KEYS:
            self.counts['pushes'] += key == 'inputs/push'
            self.counts['resets'] += getattr(message, 'command', '') == 'reset'
            self._pushes.read(entry)
        elif key == 'inputs/pin':
            self.counts['pins' if message.pinned else 'releases'] += 1
        if key == 'state':
            if not self.rows:
                self.rows, self.cols = message.rows, message.cols
            self.device = message.device
            self.stopped |= message.run_state == _STOPPED
        if key in MODE_KEYS:
            self._modes.read(entry)

    def _read_grasp(self, entry: Entry) -> None:
        name, now = entry.message.name, entry.time
        begin, end = self._grasps.get(name, (now, now))
        self._grasps[name] = min(begin, now), max(end, now)

    def _read_points(self, entry: Entry) -> None:
        if self._unusable:
            return
        try:
            frame = Frame.from_points(entry.time, entry.message)
        except ClothSimError as error:
            # The other topics can still be read.
            self._unusable = str(error)
            return
        size = frame.records.shape
        if self._has_points and size != (self.rows, self.cols):
            raise ClothSimError(
                f'{self.path} has a cloud of {size[0]} x {size[1]} nodes at {entry.time:g} s '
                f'after clouds of {self.rows} x {self.cols}: give a recording of one cloth')
        self.rows, self.cols = size
        self._has_points = True
        strain = frame.strain[frame.present]
        self.strains.add(strain)
        self._table.put(entry.resets, entry.time, {
            'mean_strain': strain.mean(dtype=float),
            'mean_height': frame.records['z'][frame.present].mean(dtype=float)})
        self._largest_strain(entry, float(strain.max()))

    def _read_stats(self, entry: Entry) -> None:
        values = {}
        for name in STATS:
            if hasattr(entry.message, name):
                values[name] = getattr(entry.message, name)
            else:
                self._without.add(name)
        self._table.put(entry.resets, entry.time, values)

    def _largest_strain(self, entry: Entry, strain: float) -> None:
        if 'stats' in self.missing:
            # The node at the spring with the largest strain has that strain.
            self._table.put(entry.resets, entry.time, {'max_strain': strain})

    def _said(self) -> list[str]:
        said = []
        if self._unusable:
            said.append(f'points were left out: {self._unusable}')
        if self._without:
            said.append(
                f'stats of another version: without {", ".join(sorted(self._without))}')
        return said
