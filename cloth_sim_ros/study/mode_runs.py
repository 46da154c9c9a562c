# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs in which modes are compared: which settings compete, how they stretch and cost."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import field
import math
import time
from types import MappingProxyType
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

# Light, so that springs have to be stepped often, and dropped, so that it is caught by its pins.
LIGHT_CLOTH: Mapping[str, Any] = MappingProxyType({
    'width': 1.0, 'height': 1.0, 'areal_density': 0.15, 'pins': ('top_left', 'top_right'),
    'start.pose': 'horizontal', 'material.preset': 'none'})
BASELINE = 'mass_spring'
_STRAIN_LIMIT = 0.01


@dataclass(frozen=True)
class StretchBound:
    """
    The most that a cloth may stretch for its speed to be compared.

    :param peak: of Stretch.peak
    :param percentile: of Stretch.worst_frame_percentile
    """

    peak: float
    percentile: float = math.inf

    def __str__(self) -> str:
        """Return the bound in words."""
        text = f'peak <= {100.0 * self.peak:g} %'
        if self.percentile < math.inf:
            text += f', 95th percentile <= {100.0 * self.percentile:g} %'
        return text


@dataclass(frozen=True)
class Contender:
    """
    One way to step the light cloth.

    :param values: scene parameters besides those of the cloth
    :param bound: on its stretch
    """

    name: str
    values: Mapping[str, Any]
    bound: StretchBound = field(default=StretchBound(peak=_STRAIN_LIMIT))

    def scene(self, grid: int) -> Scene:
        """
        Return the light cloth with ``grid`` nodes along each side.

        :raises ClothSimError: when a value is wrong
        """
        return Scene({**LIGHT_CLOTH, 'rows': grid, 'cols': grid, **self.values})


CONTENDERS = {contender.name: contender for contender in (
    Contender(BASELINE, {
        'mode': 'mass_spring', 'stiffness.structural': 1e4, 'stiffness.shear': 1e4}),
    # Fine cloth is carried by the few edges beside its pins: what keeps the bound there.
    Contender('stiffer_springs', {
        'mode': 'mass_spring', 'stiffness.structural': 2.4e4, 'stiffness.shear': 2.4e4}),
    # A step of a frame: substeps follow from how fast edges turn.
    Contender('constraint', {
        'mode': 'constraint', 'constraint.hard': ('structural', 'shear'),
        'constraint.strain': 0.006, 'dt': 0.02, 'solver.tolerance': 0.02}),
    Contender('adaptive', {
        'mode': 'adaptive', 'adaptive.threshold': _STRAIN_LIMIT, 'dt': 0.02,
        'solver.tolerance': 0.04,
        'stiffness.structural': 1e3, 'stiffness.shear': 1e3},
        # A limit engages beyond its strain and holds the edge there, hence the margins.
        StretchBound(peak=2.0 * _STRAIN_LIMIT, percentile=1.2 * _STRAIN_LIMIT)),
)}


# How far the edges of a cloth stretch in a run.

# Families of the edges that are measured. Bend springs may stretch: they only model bending.
STRETCHED_FAMILIES = ('structural', 'shear')
_PERCENTILE = 95.0


@dataclass(frozen=True)
class Stretch:
    """
    The stretch of structural and shear edges; see ``edge_stretch``.

    :param peak: largest of all edges and frames
    :param worst_frame_percentile: 95th percentile over the edges of a frame, in the frame where
        that is largest
    :param percentile: 95th percentile over the edges of all frames together
    """

    peak: float
    worst_frame_percentile: float
    percentile: float

    def is_within(self, bound: StretchBound) -> bool:
        """Return whether it keeps to ``bound``."""
        return self.peak <= bound.peak and self.worst_frame_percentile <= bound.percentile


def edge_stretch(scene: Scene, positions: np.ndarray) -> np.ndarray:
    """
    Return max(l / L0 - 1, 0) of every structural and shear edge, whether it is a spring or not.

    :param positions: (rows, cols, 3) [m]
    :return: (edges,) float64; an edge that is shorter than at rest counts as 0
    """
    positions = positions.astype(float)
    return np.concatenate([
        np.maximum(edges.strains(positions), 0.0).ravel()
        for edges in spring_sets(scene, STRETCHED_FAMILIES)
        if edges.family in STRETCHED_FAMILIES])


def stretch_of(frames: Sequence[np.ndarray]) -> Stretch:
    """
    Return the stretch of a run.

    :param frames: of ``edge_stretch``, (edges,) each; at least one
    """
    return Stretch(
        peak=float(max(frame.max() for frame in frames)),
        worst_frame_percentile=float(max(np.percentile(frame, _PERCENTILE) for frame in frames)),
        percentile=float(np.percentile(np.concatenate(frames), _PERCENTILE)))


class RunRecord:
    """
    Work, stretch and energy of a run, from a snapshot of each step of dt.

    :param scene: that is simulated
    :param start: snapshot before the first step
    """

    def __init__(self, scene: Scene, start: Snapshot) -> None:
        """Begin with the energy at the start."""
        self._scene = scene
        self._start_energy = self._most_energy = start.total_energy
        self._frames: list[np.ndarray] = []
        self._seconds = 0.0
        self._substeps = 0
        self._solves = 0
        self._iterations = 0.0

    def add_step(self, snapshot: Snapshot) -> None:
        """Count the work of the step of dt that ended in ``snapshot``."""
        self._seconds += snapshot.dt
        self._substeps += snapshot.substeps
        self._solves += snapshot.solves
        self._iterations += snapshot.solves * snapshot.mean_iterations

    def add_frame(self, snapshot: Snapshot) -> None:
        """Measure the cloth at the end of a frame."""
        self._frames.append(edge_stretch(self._scene, snapshot.positions))
        self._most_energy = max(self._most_energy, snapshot.total_energy)

    @property
    def stretch(self) -> Stretch:
        """Return the stretch over all frames."""
        return stretch_of(self._frames)

    @property
    def energy_rise(self) -> float:
        """
        Return the most that the energy was above that at the start, over M g L.

        Energy is kinetic, elastic and potential; M is the mass of the cloth and L its height. Of
        symplectic Euler, whose velocities are those of half a substep before, it swings by some
        per mille.
        """
        weight = self._scene.mass * float(
            np.linalg.norm(self._scene['gravity']))
        return (self._most_energy - self._start_energy) / (weight * self._scene['height'])

    @property
    def substep_rate(self) -> float:
        """Return the substeps in a simulated second [1/s]."""
        return self._substeps / self._seconds

    @property
    def solve_rate(self) -> float:
        """Return the linear solves in a simulated second [1/s]; 0 in a mode without a solver."""
        return self._solves / self._seconds

    @property
    def iterations_per_solve(self) -> float | None:
        """Return the mean iterations of a solve; None in a mode without a solver."""
        return self._iterations / self._solves if self._solves else None


# One contender on one grid: stepped in turn with others, timed, and recorded once.

FRAME = 0.02
_NOTHING = 1e-6


class TimedRun:
    """
    Simulates the same seconds in each round, a frame of 20 ms at a time.

    Set-up and what the driver compiles are not timed, nor are snapshots. Steps of dt are timed one
    by one: there are snapshots between those of the first round, and all rounds are to be alike.

    :param context: GL context, which all contenders have in common
    :raises ClothSimError: when the scene can't be run, or a frame is no whole number of dt
    """

    def __init__(self, contender: Contender, grid: int, context: Context) -> None:
        """Compile everything."""
        self.contender = contender
        self.grid = grid
        scene = contender.scene(grid)
        self._steps = round(FRAME / scene['dt'])
        if self._steps < 1 or abs(self._steps * scene['dt'] - FRAME) > _NOTHING * FRAME:
            raise ClothSimError(
                f'a frame of {FRAME:g} s is no whole number of steps of dt, and dt of '
                f'{contender.name} is {scene["dt"]:g} s: give a dt that divides it')
        self._run = Simulation(scene, context=context)
        self._run.engines.compile_all()
        self.wall_seconds: list[float] = []
        self.processor_seconds: list[float] = []
        self._record: RunRecord | None = None
        self.failure: str | None = None

    @property
    def record(self) -> RunRecord:
        """Return what the first round has shown."""
        assert self._record is not None  # begin_round comes first
        return self._record

    @property
    def is_first_round(self) -> bool:
        """Return whether this is the round that is recorded."""
        return len(self.wall_seconds) == 1

    def begin_round(self) -> None:
        """Go back to the start."""
        self._run.reset()
        self.wall_seconds.append(0.0)
        self.processor_seconds.append(0.0)
        if self.is_first_round:
            self._record = RunRecord(self._run.scene, self._run.snapshot())

    def make_frame(self) -> None:
        """Simulate a frame; nothing once the state was lost, which ``failure`` explains."""
        if self.failure is not None:
            return
        try:
            for _ in range(self._steps):
                self._time_step()
                if self.is_first_round:
                    snapshot = self._run.snapshot()
                    self.record.add_step(snapshot)
            if self.is_first_round:
                self.record.add_frame(snapshot)
        except NonFiniteStateError as error:
            self.failure = str(error)

    def close(self) -> None:
        """Free everything on the device."""
        self._run.close()

    def _time_step(self) -> None:
        self._run.finish()
        wall, processor = time.perf_counter(), time.process_time()
        self._run.step()
        self._run.finish()
        self.wall_seconds[-1] += time.perf_counter() - wall
        self.processor_seconds[-1] += time.process_time() - processor
