# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A scene that is simulated for the view, on a thread of its own."""

from collections.abc import Callable
from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import replace
from queue import Empty
from queue import SimpleQueue
from threading import Lock
from threading import Thread
import time
from typing import Any

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.camera.depth_shades import depth_shades
from cloth_sim_ros.camera.rig import CameraRig
from cloth_sim_ros.camera.rig import COLOR
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.view.source import Moment
from cloth_sim_ros.view.source import PAUSED
from cloth_sim_ros.view.source import RUNNING
from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.source import STOPPED
import numpy as np

_Request = tuple[Callable[[Simulation], Any], Future[None]]
# Max. delay that the view catches up with [s]; a longer one makes it slower than real time.
_MOST_BEHIND = 0.1


class SceneSource(Source):
    """
    Simulates ``scene`` in real time, or slower where the device is.

    :param frame_seconds: simulated time between moments [s]
    :raises ClothSimError: when the scene cannot be run
    :raises DeviceError: when there is no device for it
    """

    can_act = True

    def __init__(
            self, scene: Scene, name: str, *, frame_seconds: float,
            is_paused: bool = False) -> None:
        """Start the simulation, and return when its first moment is there."""
        self.name = name
        self.modes = tuple(AVAILABLE)
        self.cameras = tuple(camera.name for camera in scene.cameras)
        self._scene = scene
        self._rig: CameraRig | None = None
        self._camera: CameraModel | None = None
        self._part = COLOR
        self._picture: np.ndarray | None = None
        self._frame_seconds = max(frame_seconds, scene['dt'])
        self._run_state = PAUSED if is_paused else RUNNING
        self._note = ''
        self._latest: Moment | None = None
        # None asks the thread to end.
        self._requests: SimpleQueue[_Request | None] = SimpleQueue()
        # Held while something is put into the queue, so that no request comes after the end.
        self._lock = Lock()
        self._has_ended = False
        started: Future[None] = Future()
        # The GL context lives on the thread that made it.
        self._thread = Thread(target=self._work, args=(started,), daemon=True)
        self._thread.start()
        started.result()

    def latest(self) -> Moment | None:
        """Return the latest moment."""
        return self._latest

    def set_paused(self, is_paused: bool) -> None:
        """Pause or resume the time."""
        def change(_: Simulation) -> None:
            if self._run_state == STOPPED:
                raise ClothSimError(f'{self._note}: reset first')
            self._run_state = PAUSED if is_paused else RUNNING
        self._ask(change)

    def set_mode(self, mode: str) -> None:
        """Step with ``mode`` from now on."""
        self._ask(lambda simulation: simulation.set_mode(mode))

    def show_camera(self, name: str, part: str) -> None:
        """Let moments have the picture of a camera, its COLOR or DEPTH; an empty name: none."""
        def choose(simulation: Simulation) -> None:
            if not name:
                self._camera = self._picture = None
                return
            camera = next(each for each in self._scene.cameras if each.name == name)
            if camera.frame:
                raise ClothSimError(
                    f'camera {name} is attached to the tf frame {shown(camera.frame)}, and a '
                    'scene in the view has no tf: run the scene as a node and read '
                    f'~/cameras/{name}/image, or give the camera no frame')
            # Errors of the camera go to the page that has chosen it.
            self._picture = self._taken(simulation, camera, part)
            self._camera, self._part = camera, part
        self._ask(choose)

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt while paused."""
        def make(simulation: Simulation) -> None:
            if self._run_state != PAUSED:
                raise ClothSimError('single steps need a paused simulation: pause first')
            self._advance(lambda: simulation.step(count))
        self._ask(make)

    def reset(self) -> None:
        """Go back to the start."""
        def go_back(simulation: Simulation) -> None:
            simulation.reset()
            self._note = ''
            if self._run_state == STOPPED:
                self._run_state = PAUSED
        self._ask(go_back)

    def push(
            self, force: Sequence[float], center: Sequence[float], radius: float,
            duration: float) -> None:
        """Push the nodes within ``radius`` of ``center`` [m] with ``force`` [N] in all."""
        self._ask(lambda simulation: simulation.push(
            force, duration=duration, region='sphere', center=center, radius=radius))

    def hold(self, row: int, col: int) -> None:
        """Pin the node (row, col) where it is."""
        self._ask(lambda simulation: simulation.pin(row, col))

    def release(self, row: int, col: int) -> None:
        """Release the node (row, col)."""
        self._ask(lambda simulation: simulation.release(row, col))

    def move_pin(self, row: int, col: int, target: Sequence[float]) -> None:
        """Let the pin (row, col) move to ``target`` [m]."""
        self._ask(lambda simulation: simulation.move_pin(row, col, target))

    def close(self) -> None:
        """End the simulation, after what was requested before."""
        with self._lock:
            self._has_ended = True
            self._requests.put(None)
        self._thread.join()

    def _ask(self, change: Callable[[Simulation], Any]) -> None:
        answer: Future[None] = Future()
        with self._lock:
            if self._has_ended:
                raise ClothSimError('the simulation of this view has ended: start another view')
            self._requests.put((change, answer))
        answer.result()

    def _work(self, started: Future[None]) -> None:
        try:
            simulation = Simulation(self._scene)
            self._show(simulation)
        except BaseException as error:
            started.set_exception(error)
            return
        started.set_result(None)
        try:
            self._run(simulation)
        # Such as a device that is gone: what is requested from now on is answered with it.
        except Exception as error:
            if self._latest is not None:
                self._latest = replace(self._latest, run_state=STOPPED, note=str(error))
            while (request := self._requests.get()) is not None:
                request[1].set_exception(error)
        else:
            if self._rig is not None:
                self._rig.close()
            simulation.close()

    def _run(self, simulation: Simulation) -> None:
        due = time.monotonic()
        while self._answer_requests(simulation, due):
            now = time.monotonic()
            if self._run_state == RUNNING and now >= due:
                self._advance(lambda: simulation.advance(self._frame_seconds))
                self._show(simulation)
                due = max(due + self._frame_seconds, now - _MOST_BEHIND)

    def _answer_requests(self, simulation: Simulation, due: float) -> bool:
        """Serve requests until the next frame is due; False at the end."""
        while True:
            is_running = self._run_state == RUNNING
            wait = max(due - time.monotonic(), 0.0) if is_running else None
            try:
                request = self._requests.get(timeout=wait)
            except Empty:
                return True
            if request is None:
                return False
            change, answer = request
            try:
                change(simulation)
            except BaseException as error:
                answer.set_exception(error)
            else:
                self._show(simulation)
                answer.set_result(None)

    def _advance(self, advance: Callable[[], Any]) -> None:
        try:
            advance()
        except NonFiniteStateError as error:
            self._run_state, self._note = STOPPED, str(error)

    def _taken(self, simulation: Simulation, camera: CameraModel, part: str) -> np.ndarray:
        """Return the picture of ``camera`` now, (height, width, 3) uint8."""
        if self._rig is None:
            self._rig = CameraRig(simulation, lambda _: None)
        picture = self._rig.take(camera, (part,))
        assert picture is not None
        if part == COLOR:
            assert picture.color is not None
            return picture.color
        assert picture.depth is not None
        return depth_shades(picture.depth)

    def _show(self, simulation: Simulation) -> None:
        # While paused, a page shows each step.
        if self._camera is not None and self._rig is not None and (
                self._run_state != RUNNING or self._rig.is_due(self._camera)):
            self._picture = self._taken(simulation, self._camera, self._part)
        snapshot = simulation.snapshot()
        self._latest = Moment(
            Frame(snapshot.time, snapshot.records, tuple(
                applied.push for applied in simulation.pushes), simulation.colliders),
            snapshot.mode, self._run_state, self._note, self._picture)
