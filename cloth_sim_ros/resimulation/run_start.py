# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Bring a simulation to where a recording begins."""

from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recorded_values import recorded_pose
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.resimulation.input_replay import InputReplay
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.resimulation.recorded_inputs import recorded_nodes
from cloth_sim_ros.resimulation.recorded_inputs import recorded_push
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.modes import mode_for
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

_VELOCITY = ('vx', 'vy', 'vz')


class RunStart:
    """
    The beginning of a recording: that of its run, or a moment in the middle of it.

    ``unknown`` lists the state before the recording that it lacks, so that frames may differ in
    their bits; ``refused`` the recorded inputs that can't be applied in this run.

    :param recorded: the scene as it was recorded
    :param simulation: of the same scene, or of a changed one
    """

    def __init__(self, run: RecordedRun, recorded: Scene, simulation: Simulation) -> None:
        """Sort out what was recorded."""
        self._run = run
        self._simulation = simulation
        # A recording writes by itself what holds at its beginning.
        self._replay = InputReplay(simulation, Listener(), keep_mode=True)
        self._push_entries = self._opening('inputs/push')
        self._pushes = tuple(recorded_push(entry.message) for entry in self._push_entries)
        self._recorded_own = recorded.timed_pushes()
        self._has_same_grasps = recorded.timed_grasps() == simulation.scene.timed_grasps()
        self.unknown: tuple[str, ...] = ()

    @property
    def refused(self) -> list[str]:
        """Get the inputs that can't be given in this run."""
        return self._replay.refused

    def take_up(self, steps: int) -> None:
        """
        Set everything that holds after ``steps`` steps of dt.

        :raises ClothSimError: when the recording does not hold the state in the middle of a run
        """
        if steps:
            self._continue(steps)
        else:
            self._begin()

    def _begin(self) -> None:
        # The scene's initial grasps may have been released or changed before the recording.
        recorded = {entry.message.name: entry.message for entry in self._opening('inputs/grasp')}
        for grasp in self._simulation.grasps:
            message = recorded.get(grasp.name)
            if self._has_same_grasps and not (message and _is_same(grasp, message)):
                self._simulation.release_grasp(grasp.name)
        self._take('inputs/pin')
        for entry in self._opening('inputs/grasp'):
            if not any(grasp.name == entry.message.name for grasp in self._simulation.grasps):
                self._replay.take(entry.key, entry.message)
        for key in ('inputs/pin_target', 'inputs/grasp_target', 'inputs/collider_target',
                    'inputs/wind'):
            self._take(key)
        # The simulation has those of its scene, which are first unless all were removed.
        own = len(self._recorded_own)
        if self._pushes[:own] != self._recorded_own:
            own = 0
            self._simulation.clear_pushes()
        for entry in self._push_entries[own:]:
            self._replay.take(entry.key, entry.message)

    def _continue(self, steps: int) -> None:
        simulation = self._simulation
        now = steps * simulation.dt
        records = self._records(now)
        simulation.go_on_from(
            steps, _vectors(records, 'xyz'), _vectors(records, _VELOCITY),
            pinned=self._pinned(), pushes=self._pushes_at(now), colliders=self._colliders())
        for key in ('inputs/pin_target', 'inputs/grasp', 'inputs/grasp_target', 'inputs/wind'):
            self._take(key)
        collider_targets = [
            entry for entry in self._opening('inputs/collider_target') if entry.message.speed]
        for entry in collider_targets:
            self._replay.take(entry.key, entry.message)
        unknown = []
        if mode_for(simulation.mode, simulation.scene).has_memory:
            unknown.append(f'what mode {simulation.mode} carried over from earlier steps')
        elif simulation.scene.thin_colliders:
            unknown.append('what thin colliders pressed with before')
        if self._opening('inputs/pin_target'):
            unknown.append('where the moving pins started')
        if self._opening('inputs/grasp_target'):
            unknown.append('where the moving grasps started')
        if collider_targets:
            unknown.append('where the moving colliders started')
        if any(push.region == 'sphere' and push.start < now for push in self._pushes):
            unknown.append('which nodes an active push selected when it began')
        self.unknown = tuple(unknown)

    def _records(self, now: float) -> np.ndarray:
        cloud = self._run.first_cloud
        if cloud is None:
            raise ClothSimError(
                f'the recording begins in the middle of a run, at {now:.6g} s, without ~/points '
                'at that time: record with publish.points: true, or from the start')
        records = Frame.from_points(now, cloud).records
        rows, cols = self._simulation.scene.rows, self._simulation.scene.cols
        if records.shape != (rows, cols):
            raise ClothSimError(
                f'the recording begins in the middle of a run, at {now:.6g} s, with '
                f'{records.shape[0]} x {records.shape[1]} nodes, from which {rows} x {cols} '
                'cannot continue: leave rows and cols as they are, or record from the start')
        missing = [name for name in _VELOCITY if name not in (records.dtype.names or ())]
        if missing:
            raise ClothSimError(
                f'the recording begins in the middle of a run, at {now:.6g} s, and its points '
                f'have no field {missing[0]}: record from the start')
        return records

    def _pinned(self) -> np.ndarray:
        pinned = self._simulation.scene.pinned_nodes()
        for entry in self._opening('inputs/pin'):
            node = entry.message.row, entry.message.col
            if not all(0 <= place < side for place, side in zip(node, pinned.shape)):
                raise ClothSimError(
                    f'the recording begins with a pin at node {node}, and the cloth has '
                    f'{pinned.shape[0]} x {pinned.shape[1]} nodes: record it again')
            pinned[node] = entry.message.pinned
        return pinned

    def _colliders(self) -> dict[str, Pose]:
        names = {collider.name for collider in self._simulation.colliders}
        return {
            entry.message.name: recorded_pose(entry.message.pose)
            for entry in self._opening('inputs/collider_target')
            if not entry.message.speed and entry.message.name in names}

    def _pushes_at(self, now: float) -> list[Push]:
        own = self._simulation.scene.timed_pushes()
        if own == self._recorded_own:
            return list(self._pushes)
        others = [push for push in self._pushes if push not in self._recorded_own]
        return [push for push in own if push.end > now] + others

    def _take(self, key: str) -> None:
        for entry in self._opening(key):
            self._replay.take(key, entry.message)

    def _opening(self, key: str) -> list[Entry]:
        return [entry for entry in self._run.opening if entry.key == key]


def _is_same(grasp: Grasp, message: Any) -> bool:
    return (
        grasp.nodes.tolist() == [list(node) for node in recorded_nodes(message)]
        and grasp.pose == recorded_pose(message.pose) and grasp.max_force == message.max_force)


def _vectors(records: np.ndarray, names: tuple[str, ...] | str) -> np.ndarray:
    return np.stack([records[name] for name in names], axis=-1)
