# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make a recorded run again, as far as a recording can hold it."""

from collections.abc import Iterator
from collections.abc import Mapping
import time
from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.resimulation.frame_check import FrameCheck
from cloth_sim_ros.resimulation.input_replay import InputReplay
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.resimulation.input_replay import StepClock
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.recorded_run import stamp_of
from cloth_sim_ros.resimulation.run_start import RunStart
from cloth_sim_ros.sim.device.tuning import BUILT_IN
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.modes import mode_for
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_TOUCHING

# Max. nodes [1] of a scene without a recorded point cloud that would confirm its size.
MOST_UNSEEN_NODES = 1_000_000
# Max. number between two messages: of frames at publish.rate, and of steps of dt.
MOST_FRAMES = 100
MOST_STEPS = 10_000_000

_RATE, _FRAMES = 'publish.rate', ('publish.points', 'publish.stats')
_USUAL_RATE = 50.0


class RerunLimits:
    """
    Holds what is made again against what was recorded: a few bytes can claim anything.

    :param run: the recording
    :param dt: of the recorded run [s]
    """

    def __init__(self, run: RecordedRun, dt: float) -> None:
        """Read what the recording says of its frames."""
        self._run = run
        self._dt = dt
        others = run.scene.others
        rate = others.get(_RATE)
        self._rate = rate if isinstance(rate, float) and rate > 0.0 else _USUAL_RATE
        self._has_frames = {name: others.get(name, True) is not False for name in _FRAMES}

    def check_size(self, scene: Scene, changes: Mapping[str, Any]) -> None:
        """
        Refuse a ``scene`` whose rows and cols nobody requested and no cloud shows.

        :param changes: parameters that replace recorded ones
        :raises ClothSimError: when it is so
        """
        size, shown = (scene.rows, scene.cols), self._run.shown_size
        if 'rows' in changes or 'cols' in changes:
            return
        if shown is not None and shown != size:
            raise ClothSimError(
                f'{cut(self._run.path)} has parameters of {size[0]} x {size[1]} nodes and '
                f'clouds of {shown[0]} x {shown[1]}: give --set rows=... and --set cols=..., or '
                'another recording')
        if shown is None and scene.node_count > MOST_UNSEEN_NODES:
            raise ClothSimError(
                f'{cut(self._run.path)} has parameters of {size[0]} x {size[1]} nodes but no '
                f'cloud, without which at most {MOST_UNSEEN_NODES} nodes are simulated: give '
                f'--set rows={size[0]} if they are right')

    def check_step(self, entry: Entry, duration: float, time: float) -> None:
        """
        Refuse to go on to ``entry`` when the recording should have had something before.

        :param duration: simulated, from the message before [s]
        :param time: at that message [s]
        :raises ClothSimError: when it is so
        """
        most = MOST_STEPS * self._dt
        if any(self._has_frames.values()):
            most = min(most, max(MOST_FRAMES / self._rate, MOST_FRAMES * self._dt))
        if duration > most:
            raise ClothSimError(
                f'{cut(self._run.path)} has a message on ~/{entry.key} of {time + duration:.6g} s '
                f'after one of {time:.6g} s, and at {self._rate:g} frames per second no gap is '
                f'longer than {most:.6g} s: re-simulate the recording as it was written')
        if entry.key == 'inputs/parameters':
            for parameter in entry.message.changed_parameters:
                if parameter.name in _FRAMES:
                    self._has_frames[parameter.name] = plain_value(parameter.value) is not False


# Make a recorded run again.

_STOPPED = 'stopped'


class Rerun:
    """
    A simulation that gets the inputs of a recording at their simulated times.

    It makes as many steps of dt between them as the recorded run did, and is compared with it at
    each recorded frame.

    ``changed`` names the parameters that are not as recorded, ``check`` is the comparison of the
    frames, ``inputs`` counts the inputs by kind, ``problem`` says why the run has stopped and is
    empty when it has not.

    :param changes: parameters of the scene that replace the recorded ones, by name; a mode holds
        for the whole run
    :raises ClothSimError: when it can't be made
    :raises DeviceError: when there is no GL device for it
    """

    def __init__(self, run: RecordedRun, changes: Mapping[str, Any] | None = None) -> None:
        """Make the simulation, at the moment at which the recording begins."""
        changes = dict(changes or {})
        if 'layout' in changes:
            # The recorded ones were chosen for the recorded layout.
            changes = {**vars(BUILT_IN), **changes}
        scene = run.scene.scene(changes)
        recorded = run.scene.as_recorded(changes)
        self._run = run
        self._keep_mode = 'mode' in changes
        self.changed = run.scene.changed(scene)
        self._clock = StepClock(recorded['dt'], scene['dt'])
        begin = self._clock.steps(run.begin)
        if begin < 0:
            raise ClothSimError(
                f'the recording begins at {self._clock.recorded_time(run.begin):.6g} s, before 0: '
                're-simulate the recording as it was written')
        # A run recorded beyond the stability limit is repeated without a refusal.
        self._limits = RerunLimits(run, recorded['dt'])
        self._limits.check_size(scene, changes)
        # Recordings without a tuned layout used the built-in one.
        self.simulation = Simulation(
            scene, check_stability=bool(self.changed), tuned=False)
        self.start = RunStart(run, recorded, self.simulation)
        self.start.take_up(begin)
        self.check = FrameCheck()
        self.problem = ''
        self._replay = InputReplay(self.simulation, Listener(), keep_mode=self._keep_mode)
        self._unknown_after_stop: tuple[str, ...] = ()
        self._is_at_stop = False
        self._shown: tuple[int, int] | None = None
        self._first = (0, self.simulation.steps)
        self._worked = 0.0
        self._has_cloud = False

    @property
    def refused(self) -> list[str]:
        """Get the recorded inputs that could not be given, and why."""
        return self.start.refused + self._replay.refused

    @property
    def inputs(self) -> int:
        """Get the number of inputs given after the beginning."""
        return self._replay.inputs

    @property
    def left_out_modes(self) -> int:
        """Get the number of recorded switches of the mode that were not made."""
        return self._replay.left_out_modes

    @property
    def unknown(self) -> tuple[str, ...]:
        """Get what the recording does not tell, and the bits depend on."""
        return self.start.unknown + self._unknown_after_stop

    @property
    def has_recorded_stop(self) -> bool:
        """Return whether the recording ends stopped."""
        return self._is_at_stop

    def make(self, listener: Listener) -> Iterator[float]:
        """
        Run; yield the time of each recorded frame [s], going on over resets.

        :raises ClothSimError: when the recording is not in the order of time
        """
        self._replay = InputReplay(self.simulation, listener, keep_mode=self._keep_mode)
        listener.begin()
        try:
            for entry in self._run.entries():
                if entry.key == 'state':
                    self._see_state(entry)
                    continue
                self._advance_to(entry)
                if entry.key in ('points', 'stats'):
                    if self._show(entry, listener):
                        yield entry.time
                else:
                    self._replay.take(entry.key, entry.message)
            self._try_the_stop()
        except NonFiniteStateError as error:
            self.problem = str(error)
            if self._now() != self._shown:
                self._tell(listener)
            listener.stop()

    def close(self) -> None:
        """Free everything on the device."""
        self.simulation.close()

    def _advance_to(self, entry: Entry) -> None:
        self._is_at_stop = False
        due = self._clock.steps(stamp_of(entry.message)) - self.simulation.steps
        if due < 0:
            raise ClothSimError(
                f'{self._run.path} has a message on ~/{entry.key} of '
                f'{self._clock.recorded_time(stamp_of(entry.message)):.6g} s after one of '
                f'{self.simulation.time:.6g} s, without a reset: re-simulate the recording as it '
                'was written, not one in another order')
        self._limits.check_step(entry, due * self.simulation.dt, self.simulation.time)
        begin = time.perf_counter()
        try:
            # It ends with a look at the state, so the device has done its work by then.
            self.simulation.step(due)
        finally:
            self._worked += time.perf_counter() - begin

    def _show(self, entry: Entry, listener: Listener) -> bool:
        """Compare a frame and notify the listener; return whether it is a new one."""
        if entry.key == 'stats' and self._has_cloud:
            # It belongs to the cloud before it.
            self._has_cloud = False
            return False
        self._has_cloud = entry.key == 'points'
        if self._has_cloud:
            self._compare(entry)
        # With a longer dt, several recorded frames may lie within a step.
        if 'dt' not in self.changed or self._now() != self._shown:
            self._tell(listener)
        return True

    def _tell(self, listener: Listener) -> None:
        resets, steps = self._now()
        before = self._shown or self._first
        made = steps - before[1] if resets == before[0] else steps
        if made and self._worked:
            listener.frame(
                self._worked / made, made * self.simulation.dt / self._worked)
        else:
            listener.frame(0.0, 0.0)
        self._shown, self._worked = self._now(), 0.0

    def _compare(self, entry: Entry) -> None:
        recorded = Frame.from_points(entry.time, entry.message).records
        scene = self.simulation.scene
        if recorded.shape != (scene.rows, scene.cols):
            self.check.other_grids += 1
            return
        # A run that starts from a recorded state has no previous step, so no contact flags.
        unknown_flags = FLAG_TOUCHING if self._now() == self._first and self._first[1] else 0
        self.check.compare(
            entry.time, recorded, self.simulation.snapshot().records, unknown_flags)

    def _see_state(self, entry: Entry) -> None:
        self._is_at_stop = entry.message.run_state == _STOPPED
        mode = self.simulation.mode
        if self._is_at_stop and mode_for(mode, self.simulation.scene).has_memory:
            self._unknown_after_stop = (
                f'at which step mode {mode} restarted when the run stopped',)

    def _try_the_stop(self) -> None:
        """Where the recorded run could not go on, try to."""
        if self._is_at_stop and not self.changed:
            self.simulation.step()

    def _now(self) -> tuple[int, int]:
        return (self._replay.resets, self.simulation.steps)
