# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Run a simulation to an end as fast as it goes, into a recording where one is asked for."""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
import math
from pathlib import Path
import sys
import threading
import time
from typing import Any
from typing import TYPE_CHECKING

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.termination import reporter
from tqdm import tqdm

if TYPE_CHECKING:
    from cloth_sim_ros.api.simulation_recorder import RunRecording


# The node's parameter that each stands for.
_PARAMETERS = {
    'max_bag_size': 'recording.max_bagfile_size',
    'max_bag_duration': 'recording.max_bagfile_duration',
    'max_recording_size': 'recording.max_size',
    'fsync': 'recording.fsync',
    'markers': 'recording.markers',
}


def add_recording_options(parser: ArgumentParser) -> None:
    """Add the arguments for files, limit, fsync and markers of a recording."""
    parser.add_argument(
        '--max-bag-size', type=int, metavar='BYTES',
        help='split the recording into files of this size')
    parser.add_argument(
        '--max-bag-duration', type=float, metavar='T',
        help='split the recording every T seconds of simulated time')
    parser.add_argument(
        '--max-recording-size', type=int, metavar='BYTES',
        help='stop the recording at this total size; the simulation continues')
    parser.add_argument(
        '--fsync', action='store_true', default=None,
        help='sync the recording to disk at every flush, twice a second')
    parser.add_argument(
        '--markers', action='store_true', default=None,
        help='record the markers too, so that RViz and Foxglove show surface and colliders')


def recording_changes(args: Namespace) -> list[str]:
    """Return the arguments that were given as changes of parameters, name=value."""
    given = {name: getattr(args, name) for name in _PARAMETERS}
    return [
        f'{_PARAMETERS[name]}={str(value).lower()}' for name, value in given.items()
        if value is not None]


# Say what a command is busy with while it compiles shaders.

# What takes less is not worth a word [s].
_LONG = 0.5


@contextmanager
def compile_notice(mode: str) -> Iterator[None]:
    """Say on stderr that the shaders of ``mode`` are being compiled, if the block takes long."""
    def say() -> None:
        print(f'compiling shaders for mode {mode} ...', file=sys.stderr, flush=True)

    timer = threading.Timer(_LONG, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


# Rounding of a sum of frame times, in steps of dt [1], as in Simulation.advance.
_ROUNDING = 1e-6
_BAR = '{percentage:3.0f}% |{bar}| {n:.2f}/{total:.2f} s simulated{postfix}'


class BatchRun:
    """
    Steps a simulation frame by frame and keeps what a result needs.

    ``problem`` says why the run has stopped before its end; it is empty when it has not.
    ``peak_strain`` is the largest strain of all frames, that of the start too: those that a
    recording has.

    :param node_values: the node's parameters by name; publish.rate makes the frames
    :param record_directory: folder for a recording; None records nothing
    :param setting: what that folder was given by, for errors
    """

    def __init__(
            self, simulation: Simulation, node_values: dict[str, Any],
            record_directory: str | None = None, *, setting: str = '--record') -> None:
        """Keep the parts; nothing is written yet."""
        self._simulation = simulation
        self._node_values = node_values
        self._record_directory = record_directory
        self._setting = setting
        self._frame_seconds = max(1.0 / node_values['publish.rate'], simulation.dt)
        self._recording: RunRecording | None = None
        self.steps = 0
        self.wall_seconds = 0.0
        self.peak_strain = 0.0
        self.problem = ''

    @property
    def recording_path(self) -> str:
        """Folder of the recording; empty when there is none."""
        return self._recording.path if self._recording else ''

    @property
    def recording_problem(self) -> str:
        """Why the recording does not hold the run; empty when it does."""
        return self._recording.problem if self._recording else ''

    def advance(self, seconds: float) -> None:
        """
        Simulate the whole steps of dt in ``seconds``; stop early at the last finite state.

        :raises ClothSimError: when that is no time, or less than a step
        """
        steps = self._steps_in(seconds)
        # Otherwise the compiler's time would count as that of the first frame.
        with compile_notice(self._simulation.mode):
            self._simulation.engines.compile_all()
        self._open_recording()
        try:
            self.peak_strain = self._simulation.measure().max_strain
            self._make_frames(seconds, steps)
        except KeyboardInterrupt:
            if self._recording is not None:
                self._recording.close_interrupted()
            raise
        finally:
            if self._recording is not None:
                self._recording.close()

    def _steps_in(self, seconds: float) -> int:
        dt = self._simulation.dt
        if not math.isfinite(seconds) or seconds < 0.0:
            raise ClothSimError(f'--seconds must be a finite time, got {seconds}: give 0 or more')
        steps = math.floor(seconds / dt + _ROUNDING)
        if seconds > 0.0 and not steps:
            raise ClothSimError(
                f'--seconds {seconds} is shorter than one step, dt {dt} s, so nothing would move: '
                f'give --seconds {dt} or more, or set a shorter dt')
        return steps

    def _open_recording(self) -> None:
        if self._record_directory is not None:
            # The ROS packages are needed for a recording alone.
            from cloth_sim_ros.api.simulation_recorder import RunRecording
            self._recording = RunRecording(
                self._simulation, self._node_values, self._record_directory,
                say=reporter('run'), setting=self._setting)

    def _make_frames(self, seconds: float, steps: int) -> None:
        dt = self._simulation.dt
        frames = math.ceil(seconds / self._frame_seconds - 1e-9)
        with tqdm(total=steps * dt, bar_format=_BAR, mininterval=0.2, disable=None) as bar:
            for frame in range(frames):
                done = frame * self._frame_seconds
                if not self._make_frame(min(self._frame_seconds, seconds - done)):
                    break
                made = self.steps * dt
                rate = made / self.wall_seconds if self.wall_seconds else 0.0
                bar.set_postfix_str(f'{rate:.3g} x real time', refresh=False)
                bar.update(made - bar.n)

    def _make_frame(self, seconds: float) -> bool:
        simulation = self._simulation
        first = simulation.steps
        begin = time.perf_counter()
        try:
            simulation.advance(seconds)
        except NonFiniteStateError as error:
            self.problem = str(error)
        # Reading the strain waits for the device, so the wall time holds all of the work.
        measures = simulation.measure()
        wall = time.perf_counter() - begin
        steps = simulation.steps - first
        self.steps += steps
        self.wall_seconds += wall
        self.peak_strain = max(self.peak_strain, measures.max_strain)
        if self._recording is not None:
            if steps:
                self._recording.write(wall / steps, steps * simulation.dt / wall)
            if self.problem:
                self._recording.write_stop()
        return not self.problem


def record_run(
        scene: Scene, node_values: dict[str, Any], seconds: float, directory: str | Path,
        name: str, *, check_stability: bool = True, setting: str = '--out') -> str:
    """
    Simulate ``seconds`` into ``directory``/``name``; return why either stopped early, or ''.

    :param check_stability: False lets dt pass the stability limit
    :param setting: what ``directory`` was given by, for errors
    :raises ClothSimError: when the scene can't be run, or the recording is there already
    """
    simulation = Simulation(scene, check_stability=check_stability)
    try:
        run = BatchRun(
            simulation, {**node_values, 'recording.name': name}, str(directory), setting=setting)
        run.advance(seconds)
        return run.problem or run.recording_problem
    finally:
        simulation.close()
