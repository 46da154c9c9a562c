# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run, made again."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.rerun import Rerun
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.resimulated_recording import ResimulatedRecording
import numpy as np
from rclpy.serialization import serialize_message


@contextmanager
def made_again(
        path: str | Path, node: str = 'cloth_sim', listener: Listener | None = None,
        **changes: Any) -> Iterator[Rerun]:
    """Yield the finished Rerun of a recording; __ in the name of a change stands for a dot."""
    run = RecordedRun(Recording(path, node))
    rerun = Rerun(run, {name.replace('__', '.'): value for name, value in changes.items()})
    for _ in rerun.make(listener or Listener()):
        pass
    yield rerun
    rerun.close()


def assert_same(path: str | Path, frames: int | None = None, node: str = 'cloth_sim') -> None:
    """Hold the new run to the recorded bits, at each of its ``frames`` frames."""
    with made_again(path, node) as rerun:
        check = rerun.check
        found = (rerun.problem, rerun.refused, rerun.unknown, check.first)
        assert found == ('', [], (), None), found
        assert check.equal == check.frames, check.equal
        assert check.frames == frames if frames is not None else check.frames > 0, check.frames


class Director:
    """
    Records what is done to ``simulation``, as a node does; a context manager.

    :param values: of the scene
    :param before: what is done before the recording begins
    """

    def __init__(
            self, directory: Path, values: dict[str, Any],
            before: Callable[[Simulation], None] = lambda simulation: None) -> None:
        """Make the simulation, do ``before`` and begin to record."""
        self.simulation = Simulation(Scene(values))
        before(self.simulation)
        node_values = {field.name: field.default for field in NODE_FIELDS}
        self._recording = ResimulatedRecording(
            self.simulation, node_values, str(directory), 'cloth_sim')
        self._recording.begin()
        self._recording.frame(0.0, 0.0)
        self.simulation.listener = self._recording
        self.frames = 1
        self.path = Path(self._recording.path)

    def __enter__(self) -> 'Director':
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Finish."""
        self._recording.close()
        self.simulation.close()

    def send(self, key: str, message: Any) -> None:
        """Record any message at the present moment."""
        self._recording.recording._session.write(
            key, serialize_message(message), self.simulation.time)

    def step(self, steps: int) -> None:
        """Make steps, and a frame of their end."""
        self.simulation.step(steps)
        self.frames += 1
        self._recording.frame(1e-3, 1.0)

    def set_state_unrecorded(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace the state, of which no recording tells."""
        self.simulation.listener = InputListener()
        self.simulation.set_state(positions, velocities)
        self.simulation.listener = self._recording

    def reset(self) -> None:
        """Go back to the start, and show that."""
        self.simulation.reset()
        self.step(0)

    def stop(self) -> None:
        """Tell that the run has stopped."""
        self._recording.stop()
