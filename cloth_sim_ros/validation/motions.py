# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A rag of true mass in the motions of a robot, controlled at a fixed rate.

The motions and L_s, the measure of jitter, are those of Blanco-Mulero et al., "Benchmarking the
Sim-to-Real Gap in Cloth Manipulation", 2024, DOI 10.1109/LRA.2024.3360814; see robot_paths.py.
"""

from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.robot_paths import gripper_places
from cloth_sim_ros.validation.robot_paths import RobotPath
from cloth_sim_ros.validation.row import Figure
import numpy as np

RATES = (10.0, 100.0, 1000.0)
MASSES = (0.05, 0.1)


@dataclass(frozen=True)
class Motion:
    """
    How a rag has moved.

    :param finite: False when it was lost, with what was measured until then
    :param stretch: largest strain along rows and columns, so of the threads, while grippers move
    :param shear: largest strain of a diagonal meanwhile, most of which is a change of angle
    :param jitter: mean over nodes, axes and control steps of the distance from the mean over
        three steps, meanwhile [m]
    :param rigid: that of the grippers, so of a rag that moves as they do [m]
    :param swing: mean over nodes of the speed at the end [m/s]
    :param step: median processor time of a control step [s]
    :param slowest: what 95 % of them keep within [s]
    :param substeps: in the last control step
    """

    finite: bool
    stretch: float
    shear: float
    jitter: float
    rigid: float
    swing: float
    step: float
    slowest: float
    substeps: int

    def acceleration(self, rate: float) -> float:
        """Return what ``jitter`` is as an acceleration, which no rate changes [m/s2]."""
        return 3.0 * self.jitter * rate**2


def scene_file() -> Path:
    """Return the scene of the rag."""
    return shared_directory('config') / 'fling.yaml'


def rag(mass: float, mode: str, rate: float, **changes: Any) -> dict[str, Any]:
    """Return the rag of config/fling.yaml, without its timed moves."""
    given = load_parameters(scene_file())
    values = {name: value for name, value in given.items() if not name.startswith('pin_moves.')}
    return {**values, 'total_mass': mass, 'mode': mode, 'dt': 1.0 / rate, **changes}


def jitter_of(places: Sequence[np.ndarray]) -> float:
    """Return the mean distance along an axis from the mean of three neighbours in time [m]."""
    found = np.asarray(places, dtype=float)
    return float(np.abs(found[:-2] - 2.0 * found[1:-1] + found[2:]).mean() / 3.0)


def strains(positions: np.ndarray, width: float, height: float) -> tuple[float, float]:
    """Return the largest strain along rows and columns, and that of diagonals."""
    p = np.asarray(positions, dtype=float)
    across, down = width / (p.shape[1] - 1), height / (p.shape[0] - 1)
    threads = ((p[:, 1:] - p[:, :-1], across), (p[1:] - p[:-1], down))
    diagonals = (
        (ends, float(np.hypot(across, down)))
        for ends in (p[1:, 1:] - p[:-1, :-1], p[1:, :-1] - p[:-1, 1:]))
    stretch, shear = (
        max(float(np.abs(np.linalg.norm(ends, axis=-1) / length - 1.0).max())
            for ends, length in edges)
        for edges in (threads, diagonals))
    return stretch, shear


def move_rag(
        path: RobotPath, values: Mapping[str, Any], seconds: float | None = None,
        rest: float = 1.0) -> Motion:
    """
    Move the rag by a new target for both grippers in every step of dt.

    :param seconds: of the path; all of it by default
    :param rest: how long the grippers stay where they are then [s]
    """
    with closing(Simulation(Scene(values))) as simulation:
        simulation.warm_up()
        return _move(simulation, path, path.seconds if seconds is None else seconds, rest)


def _move(
        simulation: Simulation, path: RobotPath, seconds: float, rest: float) -> Motion:
    nodes = np.argwhere(simulation.pinned_nodes()).tolist()
    corners = np.array([simulation.positions()[row, col] for row, col in nodes], dtype=float)
    scene, dt = simulation.scene, simulation.dt
    lead, end = (round(until / dt) for until in (path.lead, path.lead + seconds))
    held = corners
    places, grippers, found, spent = [], [], [(0.0, 0.0)], []
    finite = True
    try:
        for step in range(end + round(rest / dt)):
            targets = gripper_places(path, corners, min(step + 1, end) * dt)
            spent.append(_control_step(simulation, nodes, held, targets))
            held = targets
            if lead <= step < end:
                places.append(simulation.positions())
                found.append(strains(places[-1], scene['width'], scene['height']))
                grippers.append(targets)
    except NonFiniteStateError:
        finite = False
    snapshot = simulation.snapshot()
    stretch, shear = np.max(found, axis=0).tolist()
    usual, slowest = np.percentile(spent, (50.0, 95.0)).tolist()
    return Motion(
        finite and snapshot.finite, stretch, shear, jitter_of(places), jitter_of(grippers),
        float(np.linalg.norm(snapshot.velocities, axis=-1).mean()), usual, slowest,
        snapshot.substeps)


def _control_step(
        simulation: Simulation, nodes: Sequence[Sequence[int]], held: np.ndarray,
        targets: np.ndarray) -> float:
    begin = time.process_time()
    for (row, col), place, target in zip(nodes, held, targets):
        length = float(np.linalg.norm(target - place))
        if length > 1e-6 * simulation.dt:
            simulation.move_pin(row, col, target, length / simulation.dt)
    simulation.step()
    simulation.finish()
    return time.process_time() - begin


def in_air(path: RobotPath, values: Mapping[str, Any], table: float = 0.2) -> float:
    """Return for how long the lower edge of the hanging rag is above the authors' table [s]."""
    lowest = values['start.z'] - 0.5 * values['height']
    times = np.arange(0.0, path.seconds, 0.01)
    below = [time for time in times if lowest + path.offset(time)[2] < table]
    return float(below[0]) if below else path.seconds


def thread_strain(context: Context, mode: str, nodes: int, path: RobotPath) -> Figure:
    """Return the largest strain of a thread while a rag of 0.05 kg is moved, 100 times a s [%]."""
    moved = _move_in(context, path, mode, nodes)
    return Figure(100.0 * moved.stretch if moved.finite else np.inf, 0.0, 0.0)


def jitter(context: Context, mode: str, nodes: int, path: RobotPath) -> Figure:
    """Return L_s of that rag, beside that of the grippers, which is of the motion alone [um]."""
    moved = _move_in(context, path, mode, nodes)
    rigid = 1e6 * moved.rigid
    return Figure(1e6 * moved.jitter if moved.finite else np.inf, rigid, rigid)


@lru_cache(maxsize=8)
def _move_in(context: Context, path: RobotPath, mode: str, nodes: int) -> Motion:
    cols = round(nodes * 21 / 26)
    values = rag(MASSES[0], mode, 100.0, rows=nodes, cols=cols)
    with Simulation(Scene(values), context=context) as simulation:
        return _move(simulation, path, path.seconds, 0.0)
