# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/set_mode: compile a mode on a thread, and let it take over without a pause."""

from collections.abc import Callable
import threading
import time

from cloth_sim_interfaces.srv import SetMode
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.refusals import serve_later
from cloth_sim_ros.node.result_codes import InterruptedRequestError
from cloth_sim_ros.sim.engine import Preparation
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future

# How often a preparation that takes longer is reported [s].
_REPORT_PERIOD = 0.5


class ModeSwitch:
    """
    Prepare the mode that was requested last, and let it take over at the end of a step.

    :param switched: called on the device thread with the mode that steps from now on and the
        one before, which is empty for the first
    :param failed: called with a mode that cannot be prepared and the reason
    :param changed: called when what is being prepared has changed, and while it goes on
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation, *,
            switched: Callable[[str, str], None],
            failed: Callable[[str, Exception], None], changed: Callable[[], None]) -> None:
        """Wait for a mode to be requested."""
        self._device = device
        self._simulation = simulation
        self._switched = switched
        self._failed = failed
        self._changed = changed
        self._logger = node.get_logger()
        self._wanted = ''
        self._preparation: Preparation | None = None
        self._thread: threading.Thread | None = None
        self._begun = 0.0
        self._is_reported = False
        self._waiting: list[tuple[str, Future]] = []
        # The thread of a preparation triggers it; the callback runs where all others do.
        self._is_prepared = node.create_guard_condition(self._on_prepared)
        self._report_timer = node.create_timer(
            _REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._report_timer.cancel()

    @property
    def preparing(self) -> str:
        """Return the mode that is being prepared; empty when none is."""
        return self._wanted if self._preparation is not None else ''

    @property
    def compiled(self) -> int:
        """Return how many of its programs are ready."""
        # The device thread asks, while the ROS thread may end the preparation.
        preparation = self._preparation
        return preparation.compiled if preparation is not None else 0

    def ask(self, mode: str) -> None:
        """
        Switch to ``mode`` as soon as it is compiled, and to no mode requested before.

        :raises ClothSimError: when it can't step this scene
        """
        self._simulation.engines.check(mode)
        self._wanted = mode
        self._refuse_others()
        if self._preparation is not None and self._preparation.mode != mode:
            self._preparation.cancel()
        if self._simulation.engines.has(mode):
            self._have_taken_over(mode)
        elif self._preparation is None:
            self._prepare(mode)

    def is_done(self, mode: str) -> Future:
        """Return a future that is done when ``mode`` has taken over, or will not."""
        future = Future()
        if self._simulation.is_ready and self._simulation.mode == mode and not self._wanted:
            future.set_result(None)
        else:
            self._waiting.append((mode, future))
        return future

    def close(self) -> None:
        """Let a preparation end; waits for the program that is being compiled."""
        if self._preparation is not None:
            self._preparation.cancel()
            self._join()

    def _prepare(self, mode: str) -> None:
        preparation = self._simulation.engines.preparation(mode)
        self._preparation = preparation
        self._begun = time.monotonic()
        self._is_reported = False

        def run() -> None:
            preparation.run()
            self._is_prepared.trigger()

        self._thread = threading.Thread(target=run, name=f'prepare {mode}')
        self._thread.start()
        self._report_timer.reset()
        self._changed()

    def _join(self) -> None:
        if self._thread is not None:
            self._thread.join()

    def _on_prepared(self) -> None:
        self._join()
        preparation, self._preparation = self._preparation, None
        assert preparation is not None  # it has just ended
        self._report_timer.cancel()
        if self._is_reported:
            self._logger.info(
                f'shaders for mode {preparation.mode} are compiled, after '
                f'{time.monotonic() - self._begun:.1f} s')
        if preparation.engine is not None:
            self._simulation.engines.add(preparation)
        if preparation.error is not None and preparation.mode == self._wanted:
            self._give_up(preparation.mode, preparation.error)
        elif self._wanted and self._simulation.engines.has(self._wanted):
            self._have_taken_over(self._wanted)
        elif self._wanted:
            self._prepare(self._wanted)

    def _have_taken_over(self, mode: str) -> None:
        """Let ``mode``, which is compiled, take over between two steps."""
        def take_over() -> Exception | None:
            # Another one may have been requested since.
            if self._wanted != mode:
                return None
            previous = self._simulation.mode if self._simulation.is_ready else ''
            try:
                self._simulation.set_mode(mode)
            except Exception as error:
                return error
            self._switched(mode, previous)
            return None

        def tell(error: Exception | None) -> None:
            if self._wanted != mode:
                return
            if error is not None:
                self._give_up(mode, error)
                return
            self._wanted = ''
            self._resolve(None)

        self._device.ask(lambda: (take_over(),), lambda outcome: tell(*outcome))

    def _give_up(self, mode: str, error: Exception) -> None:
        self._wanted = ''
        self._failed(mode, error)
        self._resolve(ClothSimError(f'mode {mode} cannot be prepared: {error}'))

    def _refuse_others(self) -> None:
        others = [(mode, future) for mode, future in self._waiting if mode != self._wanted]
        self._waiting = [entry for entry in self._waiting if entry not in others]
        for mode, future in others:
            future.set_exception(InterruptedRequestError(
                f'mode {self._wanted} was requested before mode {mode} was ready: request {mode} '
                'again'))

    def _resolve(self, error: Exception | None) -> None:
        waiting, self._waiting = self._waiting, []
        for _, future in waiting:
            if error is None:
                future.set_result(None)
            else:
                future.set_exception(error)

    def _report(self) -> None:
        # A preparation that is not wanted any more is not reported.
        if self.preparing and not self._is_reported:
            self._is_reported = True
            self._logger.info(
                f'compiling shaders for mode {self.preparing}; the first time on a machine this '
                'takes some seconds')
        self._changed()


class ModeService:
    """Serve ~/set_mode by the parameter, so that both ways have the same effect and checks."""

    def __init__(self, node: Node, simulation: Simulation, switch: ModeSwitch) -> None:
        """Make the service."""
        self._node = node
        self._simulation = simulation
        self._switch = switch
        serve_later(node, SetMode, '~/set_mode', self._set_mode)

    async def _set_mode(self, request: SetMode.Request, response: SetMode.Response) -> str:
        response.previous_mode = self._simulation.mode
        result = self._node.set_parameters_atomically(
            [Parameter('mode', Parameter.Type.STRING, request.mode)])
        if not result.successful:
            raise ClothSimError(result.reason)
        done = self._switch.is_done(request.mode)
        if not request.wait and not done.done():
            return f'mode {request.mode} becomes active when it is ready; ~/state reports when'
        await done
        return f'mode {request.mode}, was {response.previous_mode}'
