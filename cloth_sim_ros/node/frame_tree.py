# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of tf: received, kept for seconds, and the pose of one in another at a time."""

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
import math
import struct

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.node.result_codes import UnknownFrameError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import between
from cloth_sim_ros.sim.model.pose import Pose
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from tf2_msgs.msg import TFMessage

_LITTLE_ENDIAN = b'\x00\x01'
_COUNT = struct.Struct('<I')
_STAMP_AND_LENGTH = struct.Struct('<iII')
_PLACE = struct.Struct('<7d')
# Max. deviation of the length of a quaternion from 1 [1], as in tf2; beyond it is a mistake.
_TOLERANCE = 0.01

# Frame, time [ns], parent, and x y z with a quaternion x y z w.
Transform = tuple[str, int, str, tuple[float, ...]]


def read_transforms(data: bytes) -> list[Transform]:
    """
    Return the transforms of a serialised TFMessage.

    A transform takes rclpy 20 us, and this a tenth of that.

    :raises ClothSimError: when it is none
    """
    if data[:2] != _LITTLE_ENDIAN:
        data = bytes(serialize_message(deserialize_message(data, TFMessage)))
    # Alignment counts from behind the encapsulation.
    body = data[4:]
    found: list[Transform] = []
    try:
        count, = _COUNT.unpack_from(body)
        at = _COUNT.size
        for _ in range(count):
            at += -at % 4
            sec, nanosec, length = _STAMP_AND_LENGTH.unpack_from(body, at)
            at += _STAMP_AND_LENGTH.size
            parent = _name(body, at, length)
            at += length
            at += -at % 4
            length, = _COUNT.unpack_from(body, at)
            at += _COUNT.size
            frame = _name(body, at, length)
            at += length
            at += -at % 8
            place = _PLACE.unpack_from(body, at)
            at += _PLACE.size
            found.append((frame, sec * NANOSECONDS + nanosec, parent, place))
    except (struct.error, UnicodeDecodeError) as error:
        raise ClothSimError(
            f'it is no TFMessage: {error}; publish tf2_msgs/msg/TFMessage') from None
    return found


def checked_pose(frame: str, place: tuple[float, ...]) -> Pose:
    """Return the pose of ``frame`` that a transform has; ClothSimError if it makes no sense."""
    x, y, z, *rotation = place
    if not all(map(math.isfinite, place)):
        raise ClothSimError(
            f'the transform of the frame {shown(frame)} must have finite numbers, got '
            f'{list(place)}: give x, y and z [m], and a quaternion x y z w')
    length = math.hypot(*rotation)
    if abs(length - 1.0) > _TOLERANCE:
        raise ClothSimError(
            f'the rotation of the frame {shown(frame)} must be a quaternion of length 1, got '
            f'{rotation}: divide it by its length')
    qx, qy, qz, qw = rotation
    return Pose((x, y, z), (qx / length, qy / length, qz / length, qw / length))


def _name(body: bytes, at: int, length: int) -> str:
    # Names of ROS 1 begin with a slash.
    return body[at:at + max(length - 1, 0)].decode().removeprefix('/')


# Where one frame was in the last seconds, and where it was between.

# As tf2 does by default [ns].
KEPT = 10 * NANOSECONDS
# Max. samples of one frame [1]: 10 s at 200 Hz. At higher rates memory matters more.
MOST_SAMPLES = 2000


@dataclass(frozen=True, slots=True)
class Sample:
    """
    Where a frame is at one time.

    :param time: [ns], of the clock of its publisher
    :param parent: the frame that ``pose`` is given in
    :param pose: of the frame
    """

    time: int
    parent: str
    pose: Pose


class FrameHistory:
    """The samples of one frame, by the rules of tf2."""

    def __init__(self) -> None:
        """Begin without any."""
        self._times: list[int] = []
        self._samples: list[Sample] = []

    @property
    def oldest(self) -> Sample:
        """Return the sample of the earliest time."""
        return self._samples[0]

    @property
    def latest(self) -> Sample:
        """Return the sample of the latest time."""
        return self._samples[-1]

    def add(self, sample: Sample) -> None:
        """
        Keep ``sample``; of several of one time, the first counts.

        One that is older than all that is kept starts anew: its publisher was reset.
        """
        times = self._times
        if times and sample.time < times[-1] - KEPT:
            self.drop_from(times[0])
        place = bisect_left(times, sample.time)
        if place < len(times) and times[place] == sample.time:
            return
        times.insert(place, sample.time)
        self._samples.insert(place, sample)
        outdated = max(bisect_left(times, times[-1] - KEPT), len(times) - MOST_SAMPLES)
        del times[:outdated], self._samples[:outdated]

    def drop_from(self, time: int) -> None:
        """Forget the samples of ``time`` [ns] and later."""
        place = bisect_left(self._times, time)
        del self._times[place:], self._samples[place:]

    def at(self, time: int) -> Sample | None:
        """Return where the frame was at ``time`` [ns]; None outside what is known."""
        place = bisect_left(self._times, time)
        if place == len(self._times):
            return None
        after = self._samples[place]
        if after.time == time:
            return after
        if place == 0:
            return None
        before = self._samples[place - 1]
        # Between two parents, the frame is still at the first.
        if before.parent != after.parent:
            return Sample(time, before.parent, before.pose)
        share = (time - before.time) / (after.time - before.time)
        return Sample(time, before.parent, between(before.pose, after.pose, share))


# The frames of tf: which hangs on which, and where one is, seen from another, at a time.

MOST_FRAMES = 10_000

Own = Callable[[str], FrameHistory | None]
Pick = Callable[[str, FrameHistory], Sample]
# A frame, seen from itself, its parent, and on to the last one known.
_Seen = dict[str, Pose]


class FrameTree:
    """
    Keep transforms, and find the way from one frame to another, as the buffer of tf2 does.

    :param own: returns the history of a frame of this node; None for other frames
    :param way_out: what to do about a frame that is not known, for the error
    """

    def __init__(self, own: Own, way_out: str) -> None:
        """Begin with the frames of ``own`` alone."""
        self._own = own
        self._way_out = way_out
        self._moving: dict[str, FrameHistory] = {}
        self._fixed: dict[str, Sample] = {}

    def add(self, frame: str, sample: Sample, *, is_fixed: bool) -> None:
        """
        Keep where ``frame`` is.

        :param is_fixed: it is there at all times
        :raises ClothSimError: when it is its own parent, or there are too many frames
        """
        if frame == sample.parent or not frame or not sample.parent:
            raise ClothSimError(
                f'the frame {shown(frame)} has the parent {shown(sample.parent)}: give two '
                'different names')
        is_new = frame not in self._moving and frame not in self._fixed
        if is_new and len(self._moving) + len(self._fixed) >= MOST_FRAMES:
            raise ClothSimError(
                f'the frame {shown(frame)} is one more than {MOST_FRAMES}, which is the most: '
                'publish fewer frames')
        if is_fixed:
            self._moving.pop(frame, None)
            self._fixed[frame] = sample
        else:
            self._fixed.pop(frame, None)
            self._moving.setdefault(frame, FrameHistory()).add(sample)

    def forget_moving(self) -> None:
        """Forget where frames were, except for those that are fixed."""
        self._moving.clear()

    def pose(self, frame: str, to: str, time: int | None) -> Pose:
        """
        Return where ``frame`` is, seen from the frame ``to``.

        :param time: [ns]; None for the latest at which all frames between them are known
        :raises ClothSimError: when that is not known
        """
        if time is not None:
            return self._pose(frame, to, _at(frame, time))
        common = self.latest_time(frame, to)
        return self._pose(frame, to, _latest if common is None else _in_common(frame, to, common))

    def _pose(self, frame: str, to: str, pick: Pick) -> Pose:
        here, there, meeting = self._meet(frame, to, pick)
        return there[meeting].inverse.placed(here[meeting])

    def _meet(self, frame: str, to: str, pick: Pick) -> tuple[_Seen, _Seen, str]:
        """Return ``frame`` and ``to``, each seen from its parents, and the first in common."""
        here, reason = self._seen_from_parents(frame, pick)
        there, other_reason = self._seen_from_parents(to, pick, until=here)
        meeting = next(reversed(there))
        if meeting in here:
            return here, there, meeting
        raise reason or other_reason or self._not_connected(frame, to, here, there)

    def _seen_from_parents(
            self, frame: str, pick: Pick,
            until: _Seen | None = None) -> tuple[_Seen, ClothSimError | None]:
        """Return the pose of ``frame`` in it and its parents, and why no more are known."""
        found = {frame: Pose((0.0, 0.0, 0.0))}
        place = frame
        while until is None or place not in until:
            try:
                sample = self._sample(place, pick)
            except ClothSimError as error:
                return found, error
            if sample is None:
                break
            if sample.parent in found:
                return found, _in_a_circle(found)
            found[sample.parent] = sample.pose.placed(found[place])
            place = sample.parent
        return found, None

    def latest_time(self, frame: str, to: str) -> int | None:
        """
        Return the latest time [ns] that all frames between have; None where none moves.

        :raises ClothSimError: when they are not connected
        """
        here, there, meeting = self._meet(frame, to, _latest)
        times = []
        for chain in (here, there):
            for name in chain:
                if name == meeting:
                    break
                history = self._history(name)
                if history is not None:
                    times.append(history.latest.time)
        return min(times, default=None)

    def _history(self, frame: str) -> FrameHistory | None:
        return self._own(frame) or self._moving.get(frame)

    def _sample(self, frame: str, pick: Pick) -> Sample | None:
        history = self._history(frame)
        return self._fixed.get(frame) if history is None else pick(frame, history)

    def _not_connected(
            self, frame: str, to: str, here: _Seen, there: _Seen) -> ClothSimError:
        if len(here) == 1 and not self._is_parent(frame):
            return UnknownFrameError(
                f'its frame {shown(frame)} is not known: {self._way_out}, or give another one, '
                f'such as {shown(to)}, the frame of the cloth')
        ends = [next(reversed(chain)) for chain in (here, there)]
        return UnknownFrameError(
            f'its frame {shown(frame)} is not connected to {shown(to)}, the frame of the cloth: '
            f'publish a transform between {shown(ends[0])} and {shown(ends[1])}, or start the '
            'node with a frame_id that is connected')

    def _is_parent(self, frame: str) -> bool:
        return any(sample.parent == frame for sample in self._fixed.values()) or any(
            history.latest.parent == frame for history in self._moving.values())


def _latest(_: str, history: FrameHistory) -> Sample:
    return history.latest


def _at(frame: str, time: int) -> Pick:
    def pick(name: str, history: FrameHistory) -> Sample:
        sample = history.at(time)
        if sample is None:
            raise UnknownFrameError(
                f'the stamp of its frame {shown(frame)} is {seconds(time)} s but {shown(name)} is '
                f'known {_span(history)}: give a stamp in between, or 0 for the latest')
        return sample

    return pick


def _in_common(frame: str, to: str, time: int) -> Pick:
    def pick(name: str, history: FrameHistory) -> Sample:
        sample = history.at(time)
        if sample is None:
            raise UnknownFrameError(
                f'its frame {shown(frame)} and {shown(to)} have no time in common, as what is '
                f'between them is known up to {seconds(time)} s and {shown(name)} '
                f'{_span(history)}: have their publishers use the same clock')
        return sample

    return pick


def _in_a_circle(frames: _Seen) -> ClothSimError:
    names = ', '.join(shown(name) for name in list(frames)[:3])
    return UnknownFrameError(
        f'{len(frames)} frames on /tf hang on each other in a circle, {names}: let each frame '
        'have one parent, and one of them none')


def _span(history: FrameHistory) -> str:
    return f'from {seconds(history.oldest.time)} to {seconds(history.latest.time)} s'


def seconds(time: int) -> str:
    """Return ``time`` [ns] in seconds, with all its digits."""
    whole, part = divmod(abs(time), NANOSECONDS)
    digits = f'{whole}.{part:09d}'.rstrip('0').rstrip('.')
    return f'-{digits}' if time < 0 else digits
