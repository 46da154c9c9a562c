# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Publish a recording's messages again, in their order and at their pace."""

from collections import deque
from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Iterator
from dataclasses import dataclass
from dataclasses import field
import time

from builtin_interfaces.msg import Time
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.played_topics import CLOCK
from cloth_sim_ros.playback.played_topics import has_header
from cloth_sim_ros.playback.played_topics import header_stamp
from cloth_sim_ros.playback.played_topics import open_topics
from cloth_sim_ros.playback.played_topics import other_publishers
from cloth_sim_ros.playback.played_topics import PATIENCE
from cloth_sim_ros.playback.played_topics import PlayedTopic
from cloth_sim_ros.playback.played_topics import wanted_topics
from cloth_sim_ros.playback.played_topics import warning_of
from cloth_sim_ros.playback.schedule import PlayClock
from cloth_sim_ros.playback.schedule import PlayOptions
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.stepping import LATEST
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool

# Later than this [s] is worth a word; schedulers alone make a few milliseconds.
_LATE = 0.05


@dataclass
class PlayReport:
    """
    What came of playing a recording.

    :param messages: that were published
    :param rounds: begun, more than one with --loop
    :param furthest_behind: of any message, behind its time on the wall clock [s]
    :param slipped: by how much the schedule was moved, as it could not be kept [s]
    :param overruns: messages sent to readers that had not taken those before, by topic
    :param damaged: messages that were left out, by topic
    """

    messages: int = 0
    rounds: int = 0
    furthest_behind: float = 0.0
    slipped: float = 0.0
    overruns: dict[str, int] = field(default_factory=dict)
    damaged: dict[str, int] = field(default_factory=dict)

    def sentences(self) -> list[str]:
        """Return it in words: what was played, then what went wrong."""
        rounds = f' in {self.rounds} rounds' if self.rounds > 1 else ''
        behind = 'in time' if self.furthest_behind < _LATE else (
            f'at most {self.furthest_behind:.2g} s late')
        found = [f'played {self.messages} messages{rounds}, {behind}']
        if self.slipped:
            found.append(
                f'this took {self.slipped:.2g} s longer than intended, as the machine or the '
                'subscribers could not keep up: nothing was dropped, but use a lower --rate')
        for topic, count in self.damaged.items():
            found.append(
                f'{count} messages of {cut(topic)} were left out, as they are damaged: record '
                'them again')
        for topic, count in self.overruns.items():
            found.append(
                f'a subscriber of {topic} may have lost up to {count} messages, as it did not '
                'read them in time: use a lower --rate, or a deeper queue in that subscriber')
        return found


# The player's place in the ROS graph, with /clock where a recording has none.

NODE_NAME = 'cloth_sim_player'


class SimulatedClock:
    """
    Publish the stamp of each frame ahead of it, as a node with publish.clock does.

    ``topic`` is the topic of the clock, which waits for its readers as the others do.

    :param patience: timeout for a reader to acknowledge its messages [s]
    """

    def __init__(self, node: Node, patience: float = PATIENCE) -> None:
        """Make the publisher."""
        topic = TOPICS['clock']
        self.topic = PlayedTopic(
            node, topic.name, topic.message, QoSProfile(depth=topic.depth),
            patience=patience)
        self._latest: Time | None = None

    def read(self, message_class: type, data: bytes) -> None:
        """Publish the stamp of a serialised message of the cloth, if it has a new one."""
        if not has_header(message_class):
            return
        stamp = header_stamp(data)
        if stamp != self._latest:
            self._latest = stamp
            self.topic.publish(serialize_message(Clock(clock=stamp)))


class PlayerNode:
    """
    A node with the service ~/pause; a context manager.

    :param clock: that ~/pause stops and lets go on, by time.monotonic
    """

    def __init__(self, clock: PlayClock) -> None:
        """Join the graph."""
        self._clock = clock
        # In a context of its own, rclpy leaves the signals alone.
        self._context = Context()
        rclpy.init(args=[], context=self._context)
        self.node = Node(
            NODE_NAME, context=self._context, start_parameter_services=False,
            enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)

    def __enter__(self) -> 'PlayerNode':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the graph."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def offer_pause(self) -> None:
        """Offer ~/pause: last, so that who finds it has found the topics before."""
        self.node.create_service(SetBool, '~/pause', self._pause)

    def spin(self, seconds: float) -> None:
        """Wait up to ``seconds`` for a call of the service, and answer it."""
        self._executor.spin_once(timeout_sec=seconds)

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        if request.data:
            self._clock.pause(time.monotonic())
        else:
            self._clock.resume(time.monotonic())
        response.success = True
        response.message = 'paused' if request.data else 'playing'
        return response


# A signal is seen, and ~/pause answered, within this wall time [s].
_LOOK_UP = 0.05
# For the readers to take the last messages before their publishers are gone [s]. They need far
# less; their word that they have them can come seconds later, with the next heartbeat.
_FAREWELL = 0.5
_NANOSECONDS = 1e9
# A wait before a message that is worth a word [s]; chosen: who watches has not yet given up.
_LONG = 10.0


class Player:
    """
    Plays one recording to its end, or round and round.

    :param node: to publish with; its clock is the one that paces
    :param stopped: asked now and then; True ends playing
    :param warn: called with each sentence the user should read
    :param progress: called with the time since the begin of the recording, of each message [s]
    :raises ClothSimError: when there is nothing to play
    """

    def __init__(
            self, bag: BagReader, options: PlayOptions, node: PlayerNode, clock: PlayClock, *,
            stopped: Callable[[], bool], warn: Callable[[str], None],
            progress: Callable[[float], None] = lambda seconds: None) -> None:
        """Open the topics; nothing is published yet."""
        self._bag = bag
        self._options = options
        self._node = node
        self._clock = clock
        self._stopped = stopped
        self._warn = warn
        self._progress = progress
        self._begin, end = bag.span
        self._start = self._begin + round(options.start * _NANOSECONDS)
        if self._start > end:
            raise ClothSimError(
                f'--start {options.start:g} is after the end of the recording: give a time from 0 '
                f'to {(end - self._begin) / _NANOSECONDS:g}')
        self._end = min(end, self._start + options.duration * _NANOSECONDS)
        if self._end - self._start > LATEST * _NANOSECONDS:
            raise ClothSimError(
                f'{cut(bag.path)} goes on for {(end - self._begin) / _NANOSECONDS:.3g} s, longer '
                f'than the {LATEST} s of ROS time stamps, so the time of a message is damaged: '
                'play what comes before it with --duration')
        topics = wanted_topics(bag.topics, options)
        self._topics = open_topics(node.node, topics, options, warn)
        self._prepare_checks(topics)
        self._names = {name for name, _ in self._topics}
        self._published = [*self._topics.values()]
        self._simulated_clock = None
        if options.clock and CLOCK not in self._names:
            self._simulated_clock = SimulatedClock(node.node)
            self._published.append(self._simulated_clock.topic)
        self._report = PlayReport()
        self._looked_up = 0.0
        self._gap_before = 0
        node.offer_pause()

    @property
    def span(self) -> tuple[float, float]:
        """Get what is played, from and to, after the begin of the recording [s]."""
        return self._options.start, (self._end - self._begin) / _NANOSECONDS

    def play(self) -> PlayReport:
        """Play until the end, or until stopped."""
        self._wait_until(time.monotonic() + self._options.delay)
        problem = warning_of(other_publishers(self._node.node, self._all_names()))
        if problem:
            self._warn(problem)
        if self._options.paused:
            self._clock.pause(time.monotonic())
        while not self._stopped():
            self._play_once()
            if not self._options.loop:
                break
        if not self._stopped():
            self._say_farewell()
        self._report.furthest_behind = self._clock.furthest_behind
        self._report.slipped = self._clock.slipped
        self._report.overruns = {
            topic.name: topic.overruns for topic in self._published if topic.overruns}
        self._report.damaged = {
            topic.name: topic.damaged for topic in self._published if topic.damaged}
        return self._report

    def _play_once(self) -> None:
        self._report.rounds += 1
        self._clock.start(time.monotonic(), self._start)
        # A player that begins paused sends nothing: its readers may not be there yet.
        if not self._wait_for(self._start):
            return
        for message in self._kept_from_before():
            self._publish(message)
        self._clock.start(time.monotonic(), self._start)
        for message in self._bag.messages(self._names, begin=self._start):
            if message.time > self._end or not self._wait_for(message.time):
                break
            self._publish(message)
            self._progress((message.time - self._begin) / _NANOSECONDS)

    def _kept_from_before(self) -> Iterator[RawMessage]:
        """Yield what a reader that comes at the start needs of all before it, in its order."""
        if self._start <= self._begin:
            return
        kept: dict[tuple[str, str], deque[tuple[int, RawMessage]]] = {
            key: deque(maxlen=topic.kept) for key, topic in self._topics.items() if topic.kept}
        names = {name for name, _ in kept}
        for number, message in enumerate(self._bag.messages(names, end=self._start)):
            if (message.topic, message.type_name) in kept:
                kept[message.topic, message.type_name].append((number, message))
        for _, message in sorted(
                (entry for entries in kept.values() for entry in entries),
                key=lambda entry: entry[0]):
            yield message

    def _publish(self, message: RawMessage) -> None:
        topic = self._topics.get((message.topic, message.type_name))
        if topic is None:
            return
        if self._bag.problem_of(message):
            topic.damaged += 1
            return
        # Messages kept for late subscribers can be older: files of a split bag begin with them.
        is_timely = self._is_of_the_cloth(message.topic) and not topic.kept
        if self._simulated_clock is not None and is_timely:
            self._simulated_clock.read(topic.message_class, message.data)
        self._report.messages += topic.publish(message.data)

    def _wait_for(self, recorded: int) -> bool:
        """Wait until messages of ``recorded`` [ns] are due; return False when to stop."""
        while not self._stopped():
            if self._clock.paused:
                self._spin(_LOOK_UP)
                continue
            delay = self._clock.delay(time.monotonic(), recorded)
            self._tell_of_gap(delay, recorded)
            # Late, the messages go out one behind the other, but a call is still answered.
            if delay == 0.0:
                if time.monotonic() - self._looked_up > _LOOK_UP:
                    self._spin(0.0)
                    if self._clock.paused:
                        continue
                return not self._stopped()
            self._spin(min(delay, _LOOK_UP))
        return False

    def _tell_of_gap(self, delay: float, recorded: int) -> None:
        """Say that nothing comes for long before the message of ``recorded`` [ns], once."""
        if delay > _LONG and recorded != self._gap_before:
            self._gap_before = recorded
            after = (recorded - self._begin) / _NANOSECONDS
            self._warn(
                f'the next message is due in {delay:.3g} s, at {after:.10g} s of the recording: '
                f'wait, or go on from there with --start {after:.10g}')

    def _prepare_checks(self, topics: Iterable[BagTopic]) -> None:
        """Parse all definitions now: it takes a second, by which messages would be late."""
        for topic in topics:
            self._bag.prepare_check(topic.type_name)

    def _wait_until(self, wall: float) -> None:
        while not self._stopped() and (left := wall - time.monotonic()) > 0.0:
            self._spin(min(left, _LOOK_UP))

    def _spin(self, seconds: float) -> None:
        self._node.spin(seconds)
        self._looked_up = time.monotonic()

    def _say_farewell(self) -> None:
        end = time.monotonic() + _FAREWELL
        for topic in self._published:
            while not topic.settle(_LOOK_UP) and time.monotonic() < end and not self._stopped():
                pass

    def _all_names(self) -> list[str]:
        return [topic.name for topic in self._published]

    def _is_of_the_cloth(self, topic: str) -> bool:
        return topic.startswith(f'/{self._options.node.strip("/")}/')
