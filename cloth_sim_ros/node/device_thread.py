# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The thread that owns the device, and what passes between it and the thread of ROS.

The device thread steps the simulation. The ROS thread serves, serialises, publishes and records.
Jobs go from the ROS thread to the device thread, which does them between two steps of dt. Events
come back in order: outcomes of jobs, accepted inputs, frames.
"""

from collections import deque
from collections.abc import Callable
from contextlib import suppress
import threading
from typing import Any
from typing import Protocol

from cloth_sim_ros.files.errors import cut
from rclpy.task import Future

Job = Callable[[], object]
# After a fault in a turn, wall time until the next one [s]. A fault that comes again and again
# must leave time for requests.
_AFTER_FAULT = 0.1
# Max. number of frames that wait to be published [1]: as many as a publisher keeps for a reader
# that is late (messages/topics.py).
_FRAMES_KEPT = 10


class Turns(Protocol):
    """What the device thread does while there is no job."""

    def turn(self) -> float | None:
        """Work for a while; return the time to wait before the next turn [s], None for a job."""


class Event:
    """
    Something for the ROS thread.

    :param run: what to do
    :param where: its name in the log
    :param is_frame: True for a frame
    :param is_recorded: True for a frame that has to be recorded
    """

    def __init__(
            self, run: Callable[[bool], object], where: str, *, is_frame: bool = False,
            is_recorded: bool = False) -> None:
        """Begin as one that is published."""
        self.run = run
        self.where = where
        self.is_frame = is_frame
        self.is_recorded = is_recorded
        # False for a frame that a newer one has replaced.
        self.is_published = True

    @property
    def has_work(self) -> bool:
        """Return whether there is anything to do: an older frame may only be recorded."""
        return self.is_published or self.is_recorded


class DeviceThread:
    """
    Does jobs between two steps, and lets ``turns`` step in between.

    :param wake: called on the device thread when there is an event; has ``serve`` called on the
        ROS thread
    :param note: called on the ROS thread with an unexpected exception and what failed, in words;
        it may raise the exception instead
    """

    def __init__(
            self, wake: Callable[[], None], note: Callable[[Exception, str], object]) -> None:
        """Prepare; ``start`` begins."""
        self._wake = wake
        self._note = note
        self._condition = threading.Condition()
        self._jobs: deque[Job] = deque()
        self._events: deque[Event] = deque()
        # Counts jobs and served events: a change ends the wait of the device thread.
        self._changes = 0
        # Whether more than ``_FRAMES_KEPT`` waited, and some have waited ever since.
        self._is_behind = False
        self._is_closing = False
        self._has_stopped = threading.Event()
        self._may_end = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, make: Callable[[], Any], end: Callable[[], None]) -> Any:
        """
        Begin the thread.

        :param make: called there first; its result is returned, and its exception raised, here
        :param end: called there last
        """
        made: list[Any] = []
        ready = threading.Event()

        def run() -> None:
            try:
                made.append(make())
            except BaseException as error:
                made.append(error)
                return
            finally:
                ready.set()
            try:
                self._do_jobs()
            finally:
                self._has_stopped.set()
                self._may_end.wait()
                end()

        self._thread = threading.Thread(target=run, name='device')
        self._thread.start()
        ready.wait()
        if isinstance(made[0], BaseException):
            self._thread.join()
            self._thread = None
            raise made[0]
        return made[0]

    # Called on the ROS thread.

    def ask(self, job: Callable[[], Any], then: Callable[[Any], Any] | None = None) -> Future:
        """
        Have ``job`` done between two steps.

        :param then: called on the ROS thread with what ``job`` returns, before the events that
            come after it
        :return: done with the result of ``then``, or of ``job`` without one; or with an exception
        """
        return self.ask_later(lambda answer: answer(job()), then)

    def ask_later(
            self, job: Callable[[Callable[[Any], None]], Any],
            then: Callable[[Any], Any] | None = None) -> Future:
        """
        Do the same for a job that takes longer.

        :param job: is given what to call, on the device thread, with the result or an exception
        """
        future = Future()

        def resolve(result: Any) -> None:
            try:
                if isinstance(result, Exception):
                    raise result
                future.set_result(result if then is None else then(result))
            except Exception as error:
                future.set_exception(error)

        def answer(result: Any) -> None:
            self.emit(lambda: resolve(result), 'an answer')

        def do() -> None:
            try:
                job(answer)
            except Exception as error:
                answer(error)

        self.post(do)
        return future

    def wait_for(self, job: Callable[[], Any]) -> Any:
        """Return what ``job`` returns, or raise what it raises; nothing is served meanwhile."""
        done = threading.Event()
        found: list[Any] = []

        def do() -> None:
            try:
                found.append(job())
            except Exception as error:
                found.append(error)
            done.set()

        self.post(do)
        done.wait()
        if isinstance(found[0], Exception):
            raise found[0]
        return found[0]

    def post(self, job: Job) -> None:
        """Have ``job`` done between two steps."""
        with self._condition:
            self._jobs.append(job)
            self._changes += 1
            self._condition.notify()

    def serve(self) -> None:
        """
        Do what the oldest events ask for, up to and with a frame; called on the ROS thread.

        A frame takes as long as many requests, which are served in between.
        """
        try:
            while (event := self._next_event()) is not None:
                try:
                    event.run(event.is_published)
                except Exception as error:
                    self._note(error, event.where)
                if event.is_frame:
                    break
        finally:
            if self._events:
                self._wake()

    def stop(self) -> None:
        """Do no more jobs, and leave the present step; the events that wait stay."""
        with self._condition:
            self._is_closing = True
            self._changes += 1
            self._condition.notify()
        if self._thread is not None:
            self._has_stopped.wait()

    def close(self) -> None:
        """Stop, and end the thread."""
        self.stop()
        self._may_end.set()
        if self._thread is not None:
            self._thread.join()

    def serve_rest(self) -> None:
        """Do what the events that wait ask for, whatever fails; frames are only recorded."""
        while (event := self._next_event()) is not None:
            if event.is_frame and not event.is_recorded:
                continue
            with suppress(Exception):
                event.run(False)

    # Called on the device thread.

    def emit(self, run: Callable[[], object], where: str = 'an event') -> None:
        """Have ``run`` called on the ROS thread, after all that was emitted before."""
        self._emit(Event(lambda _: run(), where))

    def note(self, error: Exception, where: str) -> str:
        """Have an unexpected exception counted and logged; return it in one line."""
        self.emit(lambda: self._note(error, where))
        return f'{where}: {type(error).__name__} ({cut(error)})'

    def emit_frame(
            self, run: Callable[[bool], object], *, is_recorded: bool,
            replaces: bool = True) -> None:
        """
        Do the same with a frame.

        A thread that is late for a moment publishes all that waits. One that is slower than the
        frames publishes the newest only, until it has caught up.

        :param run: is given whether to publish the frame
        :param is_recorded: whether it has to be called even if that is False
        :param replaces: False leaves the frames that wait to be published
        """
        if replaces:
            self._leave_out_old_frames()
        self._emit(Event(run, 'a frame', is_frame=True, is_recorded=is_recorded))

    def _leave_out_old_frames(self) -> None:
        with self._condition:
            waiting = [event for event in self._events if event.is_frame and event.is_published]
            self._is_behind = bool(waiting) and (
                self._is_behind or len(waiting) >= _FRAMES_KEPT)
            if self._is_behind:
                for event in waiting:
                    event.is_published = False
                self._events = deque(event for event in self._events if event.has_work)

    @property
    def waiting_frames(self) -> int:
        """Return how many frames wait to be published or recorded."""
        with self._condition:
            return sum(event.is_frame and event.has_work for event in self._events)

    def has_jobs(self) -> bool:
        """Return whether a job waits."""
        return bool(self._jobs) or self._is_closing

    def is_closing(self) -> bool:
        """Return whether the thread is to end."""
        return self._is_closing

    def set_turns(self, turns: Turns) -> None:
        """Have ``turns`` step while there is no job; call it in ``make`` of ``start``."""
        self._turns = turns

    def _do_jobs(self) -> None:
        while not self._is_closing:
            changes = self._changes
            # Those that come meanwhile wait for the next step: a flood must not stop the cloth.
            for _ in range(len(self._jobs)):
                if self._is_closing:
                    return
                job = self._jobs.popleft()
                try:
                    job()
                except Exception as error:
                    self.note(error, 'a request')
            wait = self._turn()
            with self._condition:
                if wait != 0.0 and changes == self._changes:
                    self._condition.wait(wait)

    def _turn(self) -> float | None:
        try:
            return self._turns.turn()
        except Exception as error:
            self.note(error, 'the run')
            return _AFTER_FAULT

    def _emit(self, event: Event) -> None:
        with self._condition:
            self._events.append(event)
        self._wake()

    def _next_event(self) -> Event | None:
        with self._condition:
            while self._events:
                event = self._events.popleft()
                # The device thread may wait for frames to be served.
                self._changes += 1
                self._condition.notify()
                if event.has_work:
                    return event
        return None
