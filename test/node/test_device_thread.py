# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Jobs go to the thread that steps, between two steps, and what it reports comes back in order."""

from collections.abc import Callable
from collections.abc import Iterator
import threading

from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned
import pytest

PATIENCE = 300.0


class Steps:
    """Turns that note the order of steps, each of which waits to be let go."""

    def __init__(self, device: DeviceThread, done: list[str]) -> None:
        self.device = device
        self.done = done
        self.most = 0
        self.begun = threading.Semaphore(0)
        self.may_end = threading.Semaphore(0)
        self.fault: Exception | None = None

    def turn(self) -> float | None:
        """Make a step, if there is one to make."""
        if self.fault is not None:
            fault, self.fault = self.fault, None
            raise fault
        if self.most == 0:
            return None
        self.most -= 1
        self.begun.release()
        assert self.may_end.acquire(timeout=PATIENCE)
        self.done.append('step')
        return 0.0


class Served:
    """A device thread, and this thread instead of that of ROS."""

    def __init__(self) -> None:
        self.done: list[str] = []
        self.noted: list[tuple[Exception, str]] = []
        self.woken = threading.Semaphore(0)
        self.device = DeviceThread(
            self.woken.release, lambda error, where: self.noted.append((error, where)))
        self.steps = Steps(self.device, self.done)
        self.device.start(lambda: self.device.set_turns(self.steps), lambda: None)

    def serve_until(self, condition: Callable[[], bool]) -> None:
        """Serve each time it is woken."""
        while not condition():
            assert self.woken.acquire(timeout=PATIENCE), 'it is not woken'
            self.device.serve()

    def begin_step(self) -> None:
        """Return within a step."""
        self.steps.most = 1
        self.device.post(lambda: None)
        assert self.steps.begun.acquire(timeout=PATIENCE)


@pytest.fixture
def served() -> Iterator[Served]:
    """Lend a device thread that runs."""
    made = Served()
    yield made
    made.steps.may_end.release(1000)
    made.device.close()


def test_jobs_are_done_between_two_steps_in_order(served):
    """A push would change the cloth within a step, or come before the pin asked for earlier."""
    device = served.device
    served.begin_step()
    for name in ('pin', 'push', 'pause'):
        device.post(lambda name=name: served.done.append(name))
    assert device.has_jobs() and served.done == []
    served.steps.most = 1
    served.steps.may_end.release(2)
    device.wait_for(lambda: None)
    device.wait_for(lambda: None)
    assert served.done == ['step', 'pin', 'push', 'pause', 'step']


def test_jobs_that_bring_jobs_do_not_stop_the_cloth(served):
    """With requests faster than they are carried out, no step would be made any more."""
    device, jobs = served.device, []

    def again() -> None:
        jobs.append(1)
        if 'step' not in served.done:
            device.post(again)

    served.steps.most = 1
    served.steps.may_end.release()
    device.post(again)
    assert served.steps.begun.acquire(timeout=PATIENCE)
    device.wait_for(lambda: None)
    assert 'step' in served.done and jobs


def test_events_come_in_the_order_in_which_they_were_emitted(served):
    """A recording would have a push before the frame that it follows."""
    device, heard = served.device, []

    def work() -> None:
        device.emit(lambda: heard.append('state'))
        device.emit_frame(lambda _: heard.append('frame'), is_recorded=True)
        device.emit(lambda: heard.append('push'))
        device.emit_frame(lambda _: heard.append('next frame'), is_recorded=True)

    device.post(work)
    served.serve_until(lambda: len(heard) == 4)
    assert heard == ['state', 'frame', 'push', 'next frame']


def test_outcomes_come_before_later_events(served):
    """A recording would be stopped after a frame that came later than the request."""
    device, heard = served.device, []

    def answered() -> Callable[[object], str]:
        return lambda result: heard.append(result) or f'{result}, served'

    def work() -> str:
        device.emit(lambda: heard.append('before'))
        return 'answer'

    served.begin_step()
    future = device.ask(work, answered())
    device.post(lambda: device.emit(lambda: heard.append('after')))
    served.steps.may_end.release()
    served.serve_until(lambda: len(heard) == 3)
    assert heard == ['before', 'answer', 'after']
    assert future.result() == 'answer, served'


def test_an_answer_can_come_steps_later(served):
    """~/step would be answered before its steps are made."""
    device, answers = served.device, []
    future = device.ask_later(answers.append)
    device.wait_for(lambda: None)
    device.serve()
    assert len(answers) == 1 and not future.done()
    device.post(lambda: answers[0](7))
    served.serve_until(future.done)
    assert future.result() == 7


@pytest.mark.parametrize('error', [ClothSimError('not so'), ZeroDivisionError('by mistake')])
def test_what_a_job_raises_comes_to_who_has_asked(served, error):
    """A refusal would end the thread, or leave its caller waiting for ever."""
    device = served.device

    def fails() -> None:
        raise error

    for future in (
            device.ask(fails), device.ask(lambda: None, lambda _: fails()),
            device.ask_later(lambda _: fails()), device.ask_later(lambda answer: answer(error))):
        served.serve_until(future.done)
        assert future.exception() is error
    with pytest.raises(type(error)):
        device.wait_for(fails)
    assert device.wait_for(lambda: 'goes on') == 'goes on'
    assert not served.noted


def test_an_unexpected_exception_is_noted_and_work_goes_on(served):
    """A fault in a message, an event or a turn would leave a node that does nothing any more."""
    device = served.device
    fault = ZeroDivisionError('by mistake')

    def fails(*_: object) -> None:
        raise fault

    device.post(fails)
    device.emit(fails, 'an event that fails')
    device.emit_frame(fails, is_recorded=False)
    served.serve_until(lambda: len(served.noted) == 3)
    assert all(error is fault for error, _ in served.noted)
    assert {where for _, where in served.noted} == {
        'a request', 'an event that fails', 'a frame'}
    served.steps.fault = fault
    device.post(lambda: None)
    served.serve_until(lambda: len(served.noted) == 4)
    assert served.noted[-1] == (fault, 'the run')
    assert device.wait_for(lambda: 'goes on') == 'goes on'


def emit_frames(served, numbers, published, recorded=lambda number: False):
    """Emit frames that note whether they are published."""
    def emit() -> None:
        for number in numbers:
            served.device.emit_frame(
                lambda is_published, number=number: published.append((number, is_published)),
                is_recorded=recorded(number))

    served.device.wait_for(emit)


def test_a_short_delay_costs_no_frame(served):
    """A subscriber would miss frames of a run because the node was busy for a moment."""
    published = []
    emit_frames(served, range(10), published)
    served.serve_until(lambda: len(published) == 10)
    assert published == [(number, True) for number in range(10)]


def test_only_the_newest_frame_is_published_when_behind(served):
    """A slow subscriber would see ever older frames, and memory would fill with them."""
    device, published = served.device, []
    emit_frames(served, range(105), published)
    assert device.waiting_frames == 1
    # It is still behind: a frame waits each time.
    emit_frames(served, [105], published)
    assert device.waiting_frames == 1
    served.serve_until(lambda: bool(published))
    assert published == [(105, True)]
    device.serve()
    # It has caught up: none waited.
    emit_frames(served, [106, 107], published)
    served.serve_until(lambda: len(published) == 3)
    assert published[1:] == [(106, True), (107, True)]


def test_every_recorded_frame_is_kept(served):
    """A recording would have gaps where a viewer was slow."""
    device, frames = served.device, []
    emit_frames(served, range(20), frames, lambda number: number % 2 == 0)
    # Ten are only recorded, and the newest is published.
    assert device.waiting_frames == 11
    served.serve_until(lambda: len(frames) == 11)
    assert frames == [(number, False) for number in range(0, 20, 2)] + [(19, True)]


def test_frames_that_replace_none_are_all_published(served):
    """As fast as possible, a subscriber would get one frame in ten."""
    device, frames = served.device, []

    def show() -> None:
        for number in range(5):
            device.emit_frame(
                lambda is_published, number=number: frames.append((number, is_published)),
                is_recorded=False, replaces=False)

    device.wait_for(show)
    assert device.waiting_frames == 5
    served.serve_until(lambda: len(frames) == 5)
    assert frames == [(number, True) for number in range(5)]


def test_a_served_frame_wakes_a_run_that_is_held_back(served):
    """A recording run would stand still after the first frames that wait."""
    device, done, frames = served.device, threading.Event(), []
    made = []

    class HeldBack:
        def turn(self) -> float | None:
            if len(made) == 20:
                done.set()
                return None
            if device.waiting_frames >= 2:
                return None
            made.append(1)
            device.emit_frame(lambda _: frames.append(len(made)), is_recorded=True)
            return 0.0

    device.wait_for(lambda: device.set_turns(HeldBack()))
    served.serve_until(lambda: len(frames) == 20)
    assert done.wait(PATIENCE)
    # Each was served while at most two others waited, and one was under way.
    assert all(count - number <= 3 for number, count in enumerate(frames))


def test_requests_are_served_between_two_frames(served):
    """Whoever calls a service would wait until all frames are serialised."""
    device, heard = served.device, []

    def work() -> None:
        for number in range(2):
            device.emit(lambda number=number: heard.append(f'event {number}'))
            device.emit_frame(
                lambda _, number=number: heard.append(f'frame {number}'), is_recorded=True)

    device.wait_for(work)
    device.serve()
    assert heard == ['event 0', 'frame 0']
    device.serve()
    assert heard[2:] == ['event 1', 'frame 1']


def test_the_thread_does_not_outlive_what_cannot_be_made():
    """A node that cannot start would print why, and never end."""
    device = DeviceThread(lambda: None, lambda error, where: None)
    ended = []

    def make() -> None:
        raise ClothSimError('no such cloth')

    before = threading.active_count()
    with pytest.raises(ClothSimError, match='no such cloth'):
        device.start(make, lambda: ended.append(1))
    assert threading.active_count() == before and not ended
    device.close()


def test_a_stop_leaves_the_step_and_keeps_what_was_emitted():
    """A node would end with a step that takes seconds, or its last frames be lost."""
    with_step, abandoned, served, ended = threading.Event(), [], [], []
    device = DeviceThread(lambda: None, lambda error, where: None)

    class Runs:
        def __init__(self) -> None:
            self.simulation = Simulation(Scene({'rows': 8, 'cols': 8, 'mode': 'constraint'}))

        def turn(self) -> float | None:
            def stop() -> bool:
                with_step.set()
                return device.is_closing()

            device.emit_frame(lambda _: served.append('recorded'), is_recorded=True)
            device.emit_frame(lambda _: served.append('shown'), is_recorded=False)
            try:
                self.simulation.stepping.aim_steps(10**6)
                self.simulation.work(lambda: False, stop)
            except StepAbandoned:
                abandoned.append(self.simulation.steps)
            return 0.0

    runs = device.start(lambda: device.set_turns(Runs()) or device._turns, lambda: (
        ended.append(1), runs.simulation.close()))
    assert with_step.wait(PATIENCE)
    never_done = device.ask(lambda: served.append('too late'))
    device.stop()
    assert len(abandoned) == 1 and abandoned[0] < 10**6
    # What is made on the thread is there until it is closed.
    assert not ended
    device.serve_rest()
    assert served == ['recorded'] and not never_done.done()
    device.close()
    assert ended == [1]
    device.close()


def test_what_fails_at_the_end_keeps_nothing_else_back(served):
    """One topic that is gone would cost the recording its last frames."""
    device, heard = served.device, []

    def fails(_: bool) -> None:
        raise RuntimeError('the context is invalid')

    def work() -> None:
        device.emit_frame(fails, is_recorded=True)
        device.emit_frame(lambda is_published: heard.append(is_published), is_recorded=True)

    device.wait_for(work)
    device.stop()
    device.serve_rest()
    assert heard == [False]
    device.serve_rest()
    assert len(heard) == 1
