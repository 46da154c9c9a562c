# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Publish a recording's messages again, in their order and at their pace."""

from collections import deque
from collections.abc import Callable
from collections.abc import Iterator
import time

from cloth_sim_ros.playback.opened_topics import open_topics
from cloth_sim_ros.playback.opened_topics import other_publishers
from cloth_sim_ros.playback.opened_topics import wanted_topics
from cloth_sim_ros.playback.opened_topics import warning_of
from cloth_sim_ros.playback.play_clock import PlayClock
from cloth_sim_ros.playback.play_options import PlayOptions
from cloth_sim_ros.playback.play_report import PlayReport
from cloth_sim_ros.playback.player_node import PlayerNode
from cloth_sim_ros.playback.player_node import SimulatedClock
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.errors import ClothSimError

# A signal is seen, and ~/pause answered, within this wall time [s].
_LOOK_UP = 0.05
# For the readers to take the last messages before their publishers are gone [s]. They need far
# less; their word that they have them can come seconds later, with the next heartbeat.
_FAREWELL = 0.5
_NANOSECONDS = 1e9


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
        topics = wanted_topics(bag.topics, options)
        self._topics = open_topics(node.node, topics, options, warn)
        self._names = {name for name, _ in self._topics}
        self._published = [*self._topics.values()]
        self._simulated_clock = None
        if options.clock and '/clock' not in self._names:
            self._simulated_clock = SimulatedClock(node.node)
            self._published.append(self._simulated_clock.topic)
        self._report = PlayReport()
        self._looked_up = 0.0
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
        # What is kept for late subscribers can be older: files of a split bag begin with it.
        is_timely = self._is_of_the_cloth(message.topic) and not topic.kept
        if self._simulated_clock is not None and is_timely:
            self._simulated_clock.read(topic.message_class, message.data)
        topic.publish(message.data)
        self._report.messages += 1

    def _wait_for(self, recorded: int) -> bool:
        """Wait until messages of ``recorded`` [ns] are due; return False when to stop."""
        while not self._stopped():
            if self._clock.paused:
                self._spin(_LOOK_UP)
                continue
            delay = self._clock.delay(time.monotonic(), recorded)
            # Late, the messages go out one behind the other, but a call is still answered.
            if delay == 0.0:
                if time.monotonic() - self._looked_up > _LOOK_UP:
                    self._spin(0.0)
                return not self._stopped()
            self._spin(min(delay, _LOOK_UP))
        return False

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
