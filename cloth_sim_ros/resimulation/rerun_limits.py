# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How much may be made again: no more than a recording can hold."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene

# Without a cloud to see it by, a larger cloth has to be asked for.
MOST_UNSEEN_NODES = 1_000_000
# From a message to the next: frames by what publish.rate says, and steps of dt in any case.
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
        Refuse a ``scene`` whose rows and cols nobody asked for and no cloud shows.

        :param changes: parameters given in place of recorded ones
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
