# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One run of a study of the trade: a trajectory, a reference in float64, or a cost."""

from collections.abc import Mapping
from collections.abc import Sequence
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.simulation import SINGLE_THREAD_NODES
import numpy as np

# Passes over the springs of the cloth per iteration [1]: the product, and the multigrid cycle.
_PASSES = {'multigrid': 6, 'block_jacobi': 1}
ENERGIES = ('kinetic_energy', 'elastic_energy', 'gravitational_energy')


class Work:
    """
    Adds up passes over the springs, looked at once a frame.

    A substep of springs is one pass, and a sweep of the adaptive mode one more while an edge is
    at its limit. A substep of mode constraint has those of its solver, by the longest solve
    of the last step.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Begin with nothing."""
        self._simulation = simulation
        self._passes = 0.0
        self._substeps = 0.0

    def add(self, steps: int) -> None:
        """Count ``steps`` of dt that were like the last one."""
        snapshot, scene = self._simulation.snapshot(), self._simulation.scene
        iterations = snapshot.solves * snapshot.mean_iterations
        self._substeps += steps * snapshot.substeps
        self._passes += steps * (
            snapshot.substeps + iterations * _PASSES[scene['solver.preconditioner']])

    def in_a_second(self, seconds: float) -> dict[str, float]:
        """Return substeps and passes in a simulated second, of ``seconds`` simulated."""
        return {'substeps': self._substeps / seconds, 'passes': self._passes / seconds}


def trajectory(
        scene: dict[str, Any], *, times: Sequence[float], frame: float) -> dict[str, Any]:
    """
    Return positions at ``times``, strain and energies at every ``frame``, and the work.

    :param times: [s], whole frames and ascending
    :param frame: [s], whole steps of dt
    :return: positions (times, rows, cols, 3) [m], strains (frames,), energies (frames, 3) [J],
        processor time, and passes over the springs, each in a simulated second
    :raises ClothSimError: when the scene is refused or its state is lost
    """
    simulation = Simulation(Scene(scene))
    for moment in (frame, *times):
        if abs(moment / simulation.dt - round(moment / simulation.dt)) > 1e-6:
            raise ClothSimError(
                f'dt {simulation.dt:g} s does not divide {moment:g} s, at which runs are '
                'compared: choose another dt, or other times in the grid')
    # The first step compiles what the device puts off until then.
    simulation.step()
    simulation.reset()
    work = Work(simulation)
    positions, strains, energies = [], [], []
    processor = 0.0
    for number in range(1, round(times[-1] / frame) + 1):
        begin = time.process_time()
        steps = simulation.advance(frame)
        simulation.finish()
        processor += time.process_time() - begin
        work.add(steps)
        measures = simulation.measure()
        strains.append(measures.max_strain)
        energies.append([getattr(measures, name) for name in ENERGIES])
        if any(abs(number * frame - moment) < 1e-6 for moment in times):
            positions.append(np.array(simulation.snapshot().positions))
    result = {
        'device': simulation.device, 'positions': np.array(positions),
        'strains': np.array(strains), 'energies': np.array(energies),
        'processor_seconds': processor / times[-1], **work.in_a_second(times[-1])}
    simulation.close()
    return result


# The same springs in float64: the run that errors are measured against.


def spring_reference(
        scene: dict[str, Any], *, times: Sequence[float], frame: float) -> dict[str, Any]:
    """
    Return positions at ``times``, strain and energies at every ``frame``, as trajectory does.

    The timed moves of pins are not made here.
    """
    cloth = MassSpringReference(Scene({**scene, 'dt': frame}))
    positions, strains, energies = [], [], []
    for number in range(1, round(times[-1] / frame) + 1):
        cloth.step()
        strains.append(float(cloth.node_strain().max()))
        now = cloth.energies()
        energies.append([now.kinetic, now.elastic, now.gravitational])
        if any(abs(number * frame - moment) < 1e-6 for moment in times):
            positions.append(cloth.positions.copy())
    return {'device': 'NumPy, float64', 'positions': np.array(positions),
            'strains': np.array(strains), 'energies': np.array(energies)}


# How long settings take, measured in turn with nothing of the study beside them.


def cost(
        scene: dict[str, Any], *, settings: Sequence[Mapping[str, Any]], seconds: float,
        frame: float, rounds: int) -> dict[str, Any]:
    """
    Return wall and processor time of each setting in each round, in a simulated second.

    :param settings: scene parameters of each; in a round each has its turn, from the start
    :param seconds: simulated in a turn
    :param frame: simulated in one call, after which the device is waited for [s]
    """
    context = Context(single_thread=Scene(scene).node_count < SINGLE_THREAD_NODES)
    runs = [Simulation(Scene({**scene, **values}), context=context) for values in settings]
    for run in runs:
        # The first steps compile what the device puts off until then.
        _timed(run, frame, 1)
    frames = round(seconds / frame)
    timed = np.array([[_timed(run, frame, frames) for run in runs] for _ in range(rounds)])
    wall, processor = (timed[..., clock].T / seconds for clock in range(2))
    result = {
        'device': context.device, 'wall_seconds': wall.tolist(),
        'processor_seconds': processor.tolist()}
    for run in runs:
        run.close()
    context.close()
    return result


def _timed(run: Simulation, frame: float, frames: int) -> tuple[float, float]:
    """Return wall and processor time of ``frames`` from the start."""
    run.reset()
    run.finish()
    wall, processor = time.perf_counter(), time.process_time()
    for _ in range(frames):
        run.advance(frame)
        run.finish()
    return time.perf_counter() - wall, time.process_time() - processor
