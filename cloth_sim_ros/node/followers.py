# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps and colliders that are rigidly attached to frames of tf."""

from collections.abc import Callable
from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.refusals import LogThrottle
from cloth_sim_ros.node.result_codes import UnknownFrameError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
from cloth_sim_ros.sim.errors import WrongStateError
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import rotation_between
from cloth_sim_ros.sim.simulation import Simulation

GRASP, COLLIDER = 'grasp', 'collider'
# A frame that has not come for so long is late [s] of simulated time: a robot's tf comes at 10 Hz
# and more. Chosen: reports change and no motion does.
LATE = 0.5
# Between two lines of the log about one body [s] of wall time.
_QUIET = 1.0
# A place that is off by less is reached [m]: a body that rests would otherwise get a target with
# each frame, as tf has the noise of a robot's encoders. Far below what a float32 of 1 m has.
_REACHED = 1e-9
# Likewise an angle [rad]; the angle between two quaternions is known to the root of a rounding.
_TURNED = 1e-7


@dataclass
class Follower:
    """
    One attachment.

    :param kind: GRASP or COLLIDER
    :param name: of the body
    :param frame: of tf
    :param offset: pose of the body in the frame
    :param speed: the highest [m/s]
    :param angular_speed: the highest [rad/s]
    :param place: of the frame, when it was seen last
    :param time: of that place [ns], of the frame's publisher; None for a frame that is fixed
    :param seen: simulated time at which that came [s]
    :param target: of the body, that it got last; None for none
    :param behind: how far it was from there at the last look [m]
    :param is_late: whether the frame has not come for LATE
    """

    kind: str
    name: str
    frame: str
    offset: Pose
    speed: float
    angular_speed: float
    place: Pose
    time: int | None
    seen: float
    target: Pose | None = None
    behind: float = 0.0
    is_late: bool = False


class Followers:
    """
    Move bodies with their frames, at the beginning of each frame of the simulation.

    All of it is used on the device thread.

    :param frames: has the frames of tf
    :param base: of the stamps; where tf has the same, a body is where its frame is at that time
    :param of_scene: frames of bodies of the scene, by kind and name
    :param speeds: returns the highest speeds by default [m/s] and [rad/s]
    :param warn: is given a sentence that the user should know
    """

    def __init__(
            self, simulation: Simulation, frames: InputFrames, base: TimeBase,
            of_scene: dict[tuple[str, str], str], speeds: Callable[[], tuple[float, float]],
            warn: Callable[[str], object]) -> None:
        """Begin with those of the scene, which are attached as soon as their frames are known."""
        self._simulation = simulation
        self._frames = frames
        self._base = base
        self._of_scene = of_scene
        self._speeds = speeds
        self._warn = warn
        self._throttle = LogThrottle(_QUIET)
        self._followers: dict[tuple[str, str], Follower] = {}

    @property
    def present(self) -> tuple[Follower, ...]:
        """Return what follows a frame."""
        return tuple(self._followers.values())

    @property
    def waiting(self) -> tuple[tuple[str, str], ...]:
        """Return names of bodies of the scene that are not attached yet, and of their frames."""
        return tuple(
            (name, frame) for (kind, name), frame in self._of_scene.items()
            if (kind, name) not in self._followers)

    def check_free(self, kind: str, name: str) -> None:
        """Raise WrongStateError where the body follows a frame: it can't be moved besides."""
        follower = self._followers.get((kind, name))
        if follower is not None:
            raise WrongStateError(
                f'{kind} {name} follows the frame {shown(follower.frame)}: call ~/follow_{kind} '
                'with an empty frame first')

    def look_up(self, frame: str) -> tuple[Pose, int | None]:
        """
        Return where ``frame`` is now, and of which time that is.

        :raises ClothSimError: when it is not known, or one of the node's own
        """
        return self._frames.place(frame, self._base.at(self._simulation.time))

    def attach(
            self, kind: str, name: str, frame: str, speed: float = 0.0,
            angular_speed: float = 0.0) -> Follower:
        """
        Attach a body to ``frame``, as it stands to it now.

        :param speed: the highest [m/s]; 0 for the default
        :param angular_speed: the highest [rad/s]; 0 for the default
        :raises ClothSimError: when one of them is not there, or a speed is wrong
        """
        for value, what in ((speed, 'max_speed'), (angular_speed, 'max_angular_speed')):
            if not 0.0 <= value < math.inf:
                raise ClothSimError(
                    f'{what} must be finite and 0 or more, got {value:g}: give 0 for the default')
        body = self._pose(kind, name)
        place, time = self.look_up(frame)
        usual_speed, usual_angular = self._speeds()
        follower = Follower(
            kind, name, frame, place.inverse.placed(body), speed or usual_speed,
            angular_speed or usual_angular, place, time, self._simulation.time)
        self._followers[kind, name] = follower
        return follower

    def detach(self, kind: str, name: str) -> Follower:
        """Let a body follow no longer: it stays where it is. NotFoundError if it does not."""
        if (kind, name) not in self._followers:
            names = ', '.join(each for of, each in self._followers if of == kind) or 'none'
            raise NotFoundError(
                f'{kind} {shown(name)} follows no frame: give one of those that do, {names}')
        self._of_scene.pop((kind, name), None)
        follower = self._followers.pop((kind, name))
        pose = self._pose(kind, name)
        self._move(follower)(name, pose.position, pose.orientation)
        return follower

    def forget_grasps(self) -> None:
        """Note that time went back: grasps are those of the scene, which are attached anew."""
        self._followers = {
            key: follower for key, follower in self._followers.items() if key[0] == COLLIDER}
        for follower in self._followers.values():
            follower.seen = 0.0

    def move(self, seconds: float) -> bool:
        """
        Give each body a target that it reaches in ``seconds``; return whether there is any.

        A frame that is late leaves its body where it is, and one that jumps is followed at the
        highest speed; both are reported.
        """
        if not self._followers and not self._of_scene:
            return False
        self._attach_waiting()
        wanted = self._base.at(self._simulation.time + seconds)
        for key, follower in list(self._followers.items()):
            if self._find(*key) is None:
                del self._followers[key]
                continue
            self._look(follower, wanted)
            self._lead(follower, seconds)
        return True

    def _attach_waiting(self) -> None:
        for (kind, name), frame in self._of_scene.items():
            if (kind, name) in self._followers or self._find(kind, name) is None:
                continue
            try:
                self.attach(kind, name, frame)
            except UnknownFrameError:
                continue

    def _look(self, follower: Follower, wanted: int) -> None:
        """Look where the frame is."""
        now = self._simulation.time
        try:
            place, time = self._frames.place(follower.frame, wanted)
        except ClothSimError as error:
            self._note_late(follower, now, str(error))
            return
        if time is not None and time == follower.time:
            self._note_late(follower, now, 'no transform has come')
            return
        if follower.time is not None and time is not None:
            self._note_jump(follower, place, (time - follower.time) / NANOSECONDS)
        follower.place, follower.time, follower.seen = place, time, now
        follower.is_late = False

    def _note_late(self, follower: Follower, now: float, reason: str) -> None:
        if now - follower.seen > LATE and not follower.is_late:
            follower.is_late = True
            self._warn(
                f'{follower.kind} {follower.name} waits where it is, as its frame '
                f'{shown(follower.frame)} has not come for {now - follower.seen:.3g} s: {reason}')

    def _note_jump(self, follower: Follower, place: Pose, seconds: float) -> None:
        way = math.dist(place.position, follower.place.position)
        if way <= follower.speed * abs(seconds) + _REACHED:
            return
        if self._throttle.left_out(f'{follower.kind} {follower.name}') is not None:
            self._warn(
                f'the frame {shown(follower.frame)} has moved by {way:.3g} m in {seconds:.3g} s, '
                f'faster than {follower.speed:g} m/s: {follower.kind} {follower.name} follows at '
                'that speed; give a higher max_speed if the frame is right')

    def _lead(self, follower: Follower, seconds: float) -> None:
        target = follower.place.placed(follower.offset)
        present = self._pose(follower.kind, follower.name)
        if follower.target is not None:
            follower.behind = math.dist(present.position, follower.target.position)
        if math.dist(present.position, target.position) <= _REACHED and _is_turned_alike(
                present, target):
            return
        follower.target = target
        self._move(follower)(
            follower.name, target.position, target.orientation, follower.speed,
            follower.angular_speed, duration=seconds)

    def _move(self, follower: Follower) -> Callable[..., Any]:
        simulation = self._simulation
        return simulation.move_grasp if follower.kind == GRASP else simulation.move_collider

    def _bodies(self, kind: str) -> Sequence[Any]:
        return self._simulation.grasps if kind == GRASP else self._simulation.colliders

    def _find(self, kind: str, name: str) -> Any:
        return next((body for body in self._bodies(kind) if body.name == name), None)

    def _pose(self, kind: str, name: str) -> Pose:
        body = self._find(kind, name)
        if body is None:
            names = ', '.join(each.name for each in self._bodies(kind)) or 'none'
            raise NotFoundError(
                f'there is no {kind} {shown(name)}: give one of those that are there, {names}')
        pose: Pose = body.pose
        return pose


def _is_turned_alike(one: Pose, other: Pose) -> bool:
    return rotation_between(one.orientation, other.orientation)[1] <= _TURNED


def frames_of_scene(
        given: Sequence[str], simulation: Simulation) -> dict[tuple[str, str], str]:
    """
    Return the frames of bodies of the scene, by kind and name.

    :param given: NAME=FRAME each
    :raises ClothSimError: for one that is not of that form, or of no body
    """
    scene = simulation.scene
    names = {GRASP: {grasp.name for grasp in scene.timed_grasps()},
             COLLIDER: {collider.name for collider in scene.colliders}}
    found: dict[tuple[str, str], str] = {}
    for text in given:
        name, _, frame = text.partition('=')
        kinds = [kind for kind in names if name in names[kind]]
        if not frame or len(kinds) != 1:
            known = ', '.join(sorted(names[GRASP] | names[COLLIDER])) or 'none'
            raise ClothSimError(
                f'tf.follow has {shown(text)}, and needs NAME=FRAME with one grasp or collider of '
                f'the scene: give one of {known}')
        found[kinds[0], name] = frame
    return found
