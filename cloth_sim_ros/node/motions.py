# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Moves of pins, grasps and colliders that somebody waits for: how far they are, and their end."""

from collections.abc import Callable
from collections.abc import Sequence
from dataclasses import dataclass
import math
import time
from typing import Any

from cloth_sim_ros.node.result_codes import CanceledError
from cloth_sim_ros.node.result_codes import InterruptedRequestError
from cloth_sim_ros.node.result_codes import RunFailedError
from cloth_sim_ros.node.result_codes import StalledError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.held.force_window import ForceWindow
from cloth_sim_ros.sim.held.force_window import FrameForces
from cloth_sim_ros.sim.model.pose import NO_ROTATION
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import rotation_between
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

PIN, GRASP, COLLIDER = 'pin', 'grasp', 'collider'
# At the end point [m]: float32 has the place of a pin.
_REACHED = 1e-5
# A pin that waits for so long [s] of simulated time, as pin.max_force has it, is stalled: ten
# times as long as a wave takes to cross a cloth of 1 m. Chosen: no result depends on it.
PATIENCE = 0.5
# Between two feedbacks [s] of wall time: as often as a display shows them.
FEEDBACK_PERIOD = 0.02


@dataclass(frozen=True)
class Progress:
    """
    How far a move is.

    :param way_left: to the end point [m]
    :param angle_left: [rad]
    :param force: of the cloth, mean over the steps since the last look [N]
    :param time: simulated [s]
    """

    way_left: float
    angle_left: float
    force: float
    time: float


@dataclass
class Motion:
    """
    A move that somebody waits for.

    :param kind: PIN, GRASP or COLLIDER
    :param name: of the body; row and col of a pin
    :param path: of the simulation
    :param max_force: at which it stops [N]; 0 for none
    :param feedback: is given the progress, now and then
    :param end: is given None, or why it did not come to its end point, and the last progress
    """

    kind: str
    name: Any
    path: Any
    max_force: float
    feedback: Callable[[Progress], object]
    end: Callable[[Exception | None, Progress], object]
    progress: Progress
    told: float = -math.inf
    moved: float = 0.0

    @property
    def title(self) -> str:
        """Return its name for people."""
        return f'{self.kind} {self.name}'


class Motions:
    """
    The moves that somebody waits for; used on the device thread.

    :param problem: returns why the run has stopped; empty when it has not
    """

    def __init__(self, simulation: Simulation, problem: Callable[[], str]) -> None:
        """Begin with none."""
        self._simulation = simulation
        self._problem = problem
        self._motions: list[Motion] = []
        self._window: ForceWindow | None = None
        self._steps = -1

    def begin(
            self, kind: str, name: Any, path: Any, max_force: float,
            feedback: Callable[[Progress], object],
            end: Callable[[Exception | None, Progress], object]) -> Motion:
        """Look after a move that has just begun; the arguments are those of Motion."""
        if self._window is None:
            self._window = self._simulation.open_force_window()
        now = self._simulation.time
        motion = Motion(
            kind, name, path, max_force, feedback, end, self._progress(kind, name, path, 0.0),
            moved=now)
        self._motions.append(motion)
        return motion

    def cancel(self, motion: Motion) -> None:
        """Stop it where it is; nothing happens where it has ended."""
        if motion in self._motions:
            self._halt(motion, CanceledError(
                f'{motion.title} stands where it was when this was canceled, '
                f'{motion.progress.way_left:.3g} m before its end point'))

    def look(self) -> bool:
        """See how far they are; return whether there is any."""
        if not self._motions:
            return False
        problem = self._problem()
        if problem or self._simulation.steps != self._steps:
            self._steps = self._simulation.steps
            forces = self._forces()
            for motion in list(self._motions):
                self._look_at(motion, forces, problem)
        if not self._motions and self._window is not None:
            self._simulation.close_force_window(self._window)
            self._window = None
        return bool(self._motions)

    def _look_at(self, motion: Motion, forces: FrameForces | None, problem: str) -> None:
        now = self._simulation.time
        reason = self._interruption(motion)
        if reason is not None:
            self._end(motion, reason)
            return
        before = motion.progress
        motion.progress = progress = self._progress(
            motion.kind, motion.name, motion.path, self._force(motion, forces))
        if before.way_left - progress.way_left > _REACHED or progress.angle_left < (
                before.angle_left):
            motion.moved = now
        if problem:
            self._end(motion, RunFailedError(problem))
        elif 0.0 < motion.max_force <= progress.force:
            self._halt(motion, StalledError(
                f'{motion.title} has stopped {progress.way_left:.3g} m before its end point, as '
                f'the cloth pulls with {progress.force:.3g} N and max_force is '
                f'{motion.max_force:g} N: give way, or a higher one'))
        elif progress.way_left <= _REACHED and now >= motion.path.arrival - 1e-9:
            self._end(motion, None)
        elif now - motion.moved > PATIENCE and now > motion.path.begin:
            self._halt(motion, StalledError(
                f'{motion.title} has not moved for {PATIENCE} s, {progress.way_left:.3g} m before '
                'its end point, as edges pull with more than pin.max_force: give a nearer target'))
        else:
            self._tell(motion)

    def _interruption(self, motion: Motion) -> ClothSimError | None:
        """Return why it is not on its path any more."""
        simulation = self._simulation
        if simulation.time < motion.path.begin:
            return InterruptedRequestError(
                f'the cloth was reset before {motion.title} had arrived: ask for it again')
        if self._pose(motion.kind, motion.name) is None:
            return NotFoundError(
                f'{motion.title} is no longer there: it was released, or has lost the cloth')
        moves: Sequence[Any] = {
            PIN: lambda: simulation.pin_moves,
            GRASP: lambda: [path.move for path in simulation.grasp_paths],
            COLLIDER: lambda: [
                each.path.move for each in simulation.moved_colliders if each.path is not None],
        }[motion.kind]()
        own = [move for move in moves if _name_of(motion.kind, move) == motion.name]
        is_on_its_way = simulation.time < motion.path.arrival
        if own != [motion.path.move] and (own or (is_on_its_way and motion.kind != PIN)):
            return InterruptedRequestError(
                f'{motion.title} was given another target before it had arrived: ask for this one '
                'again')
        return None

    def _halt(self, motion: Motion, error: Exception) -> None:
        """Let it stay where it is."""
        simulation, pose = self._simulation, self._pose(motion.kind, motion.name)
        if pose is not None:
            if motion.kind == PIN:
                simulation.move_pin(motion.name[0], motion.name[1], pose.position)
            elif motion.kind == GRASP:
                simulation.move_grasp(motion.name, pose.position, pose.orientation)
            else:
                simulation.move_collider(motion.name, pose.position, pose.orientation)
            motion.progress = self._progress(
                motion.kind, motion.name, motion.path, motion.progress.force)
        self._end(motion, error)

    def _end(self, motion: Motion, error: Exception | None) -> None:
        self._motions.remove(motion)
        motion.end(error, motion.progress)

    def _tell(self, motion: Motion) -> None:
        now = time.monotonic()
        if now - motion.told >= FEEDBACK_PERIOD:
            motion.told = now
            motion.feedback(motion.progress)

    def _progress(self, kind: str, name: Any, path: Any, force: float) -> Progress:
        pose = self._pose(kind, name)
        assert pose is not None  # a missing one was refused, or has ended
        target = Pose(path.move.target) if kind == PIN else path.target
        return Progress(
            math.dist(pose.position, target.position),
            rotation_between(pose.orientation, target.orientation)[1], force,
            self._simulation.time)

    def _pose(self, kind: str, name: Any) -> Pose | None:
        simulation = self._simulation
        if kind == PIN:
            if not simulation.pinned_nodes()[name]:
                return None
            x, y, z = map(float, simulation.positions()[name])
            return Pose((x, y, z), NO_ROTATION)
        bodies: Sequence[Any] = simulation.grasps if kind == GRASP else simulation.colliders
        return next((body.pose for body in bodies if body.name == name), None)

    def _forces(self) -> FrameForces | None:
        if self._window is None or not self._simulation.knows_forces:
            return None
        return self._simulation.frame_forces(self._window)

    def _force(self, motion: Motion, forces: FrameForces | None) -> float:
        """Return the force of the cloth on the body [N]."""
        if forces is None:
            return 0.0
        if motion.kind == PIN:
            found = (forces.pins.nodes == motion.name).all(axis=1)
            return float(np.linalg.norm(forces.pins.forces[found].sum(axis=0)))
        felt: Sequence[Any] = forces.grasps if motion.kind == GRASP else forces.contacts
        return next((
            float(np.linalg.norm(each.force)) for each in felt if each.name == motion.name), 0.0)


def _name_of(kind: str, move: Any) -> Any:
    return move.node if kind == PIN else move.name
