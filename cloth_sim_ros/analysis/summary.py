# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""A recording in a few numbers."""

from dataclasses import dataclass
from dataclasses import field
import math
from statistics import median

from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording

# ClothState.STOPPED: a recording is read without the interfaces.
_STOPPED = 'stopped'


@dataclass
class Summary:
    """
    What happened in a recording.

    :param device: GL_RENDERER; empty where the recording does not say
    :param modes: each once, in the order they came
    :param begin: time of the first frame [s]
    :param end: time of the last frame [s]
    :param dt: [s]
    :param largest_strain: of all springs over all frames
    :param largest_kinetic_energy: over all frames [J]
    :param first_energy: total energy of the first frame [J]
    :param last_energy: total energy of the last frame [J]
    :param finite: False when the run stopped because the next state was not finite
    :param factors: real-time factors of the frames that ran
    """

    device: str = ''
    rows: int = 0
    cols: int = 0
    modes: list[str] = field(default_factory=list)
    begin: float = 0.0
    end: float = 0.0
    frames: int = 0
    dt: float = 0.0
    substeps: int = 0
    largest_strain: float = 0.0
    last_strain: float = 0.0
    largest_kinetic_energy: float = 0.0
    last_kinetic_energy: float = 0.0
    first_energy: float = math.nan
    last_energy: float = math.nan
    finite: bool = True
    factors: list[float] = field(default_factory=list, repr=False)
    pushes: int = 0
    pins: int = 0
    releases: int = 0
    resets: int = 0

    @property
    def duration(self) -> float:
        """Get the simulated time from the first to the last frame [s]."""
        return self.end - self.begin

    @property
    def real_time_factor(self) -> float:
        """Get the median real-time factor of the frames that ran; 0 when none did."""
        return median(self.factors) if self.factors else 0.0

    def read(self, entry: Entry) -> None:
        """Take up one message of a topic in _READERS."""
        _READERS[entry.key](self, entry)

    def _read_points(self, entry: Entry) -> None:
        if not self.frames:
            self.begin = entry.time
        self.end = entry.time
        self.frames += 1
        self.rows, self.cols = entry.message.height, entry.message.width

    def _read_stats(self, entry: Entry) -> None:
        stats = entry.message
        self.dt, self.substeps = stats.dt, stats.substeps
        if stats.real_time_factor > 0.0:
            self.factors.append(stats.real_time_factor)
        self.finite = math.isfinite(stats.total_energy)
        if not self.finite:
            return
        self.last_strain, self.last_kinetic_energy = stats.max_strain, stats.kinetic_energy
        self.largest_strain = max(self.largest_strain, stats.max_strain)
        self.largest_kinetic_energy = max(self.largest_kinetic_energy, stats.kinetic_energy)
        self.last_energy = stats.total_energy
        if math.isnan(self.first_energy):
            self.first_energy = stats.total_energy

    def _read_state(self, entry: Entry) -> None:
        self.device = entry.message.device
        if entry.message.run_state == _STOPPED:
            self.finite = False

    def _read_mode(self, entry: Entry) -> None:
        if entry.message.mode not in self.modes:
            self.modes.append(entry.message.mode)

    def _read_pin(self, entry: Entry) -> None:
        if entry.message.pinned:
            self.pins += 1
        else:
            self.releases += 1

    def _read_push(self, _: Entry) -> None:
        self.pushes += 1

    def _read_command(self, entry: Entry) -> None:
        self.resets += entry.message.command == 'reset'


_READERS = {
    'points': Summary._read_points,
    'stats': Summary._read_stats,
    'state': Summary._read_state,
    'inputs/mode': Summary._read_mode,
    'inputs/pin': Summary._read_pin,
    'inputs/push': Summary._read_push,
    'inputs/command': Summary._read_command,
}


def summarise(recording: Recording) -> Summary:
    """Read ``recording`` once and return its summary; ClothSimError when it holds no frame."""
    summary = Summary()
    for entry in recording.entries(*_READERS):
        summary.read(entry)
    if not summary.frames:
        raise recording.no_frame()
    return summary
