# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a cloth is stable at one dt: at rest, as it moves, and as it hangs."""

from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigsh
from scipy.sparse.linalg import splu

STABLE = 'stable'
UNSTABLE = 'unstable'
REFUSED = 'refused'

# Amplitude over that at the start [1] from which a run is unstable. At 0.999 of the limit a stable
# wave reaches 22; at 1.001 it grows by a factor of 1.09 per step.
GROWN = 30.0


@dataclass(frozen=True)
class ProbeOutcome:
    """
    The end of one run.

    :param outcome: stable, unstable or refused
    :param growth: largest amplitude over that at the start; infinite for what is not finite
    :param substeps: of the last dt; 0 where the scene was refused
    :param detail: why it was refused, or why the run stopped
    """

    outcome: str
    growth: float = 0.0
    substeps: int = 0
    detail: str = ''

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON, which has no infinity: None in its place."""
        return {**vars(self), 'growth': self.growth if math.isfinite(self.growth) else None}


def grown(growth: float, substeps: int, detail: str = '') -> ProbeOutcome:
    """Return the outcome of a run whose amplitude has become ``growth`` times that at first."""
    # NaN fails the comparison, and is unstable.
    return ProbeOutcome(STABLE if growth < GROWN else UNSTABLE, growth, substeps, detail)


# Whether the flat cloth at rest stays at rest, with springs and one step a dt.

# Small, so that springs answer in proportion; large beside what float32 rounds of a position.
JITTER = 1e-3
# Each of the first steps is looked at: in mode adaptive, what grows fast soon comes to the strain
# limit and is held there. The others are looked at after so many.
_FIRST_LOOKS = 50
_LATER_LOOKS, _STEPS_A_LOOK = 11, 50


def rest_scene(values: Mapping[str, Any]) -> dict[str, Any]:
    """
    Return the cloth of ``values`` alone: no gravity, no pins, no pushes, all its waves seeded.

    It lies at the origin, where float32 has most digits.
    """
    alone = {name: value for name, value in values.items()
             if not name.startswith(('pushes.', 'pin_moves.'))}
    return {
        **alone, 'gravity': [0.0, 0.0, 0.0], 'start.pose': 'horizontal', 'start.z': 0.0,
        'start.jitter': JITTER, 'pins': ['none'], 'auto_substeps': False, 'substeps': 1}


def rest_probe(
        values: Mapping[str, Any], dt: float, *, context: Context | None = None) -> ProbeOutcome:
    """
    Step the cloth of ``values`` at rest by ``dt`` [s], beyond any check, and look at its growth.

    The growth is the root of kinetic and elastic energy over those at the start. Below the limit
    a conserved energy bounds it; above, the fastest wave grows without end.
    """
    scene = Scene({**rest_scene(values), 'dt': dt})
    with closing(Simulation(
            scene, context=context, check_stability=False, stop_at_non_finite=False)) as run:
        begin = _energy(run)
        growth = 1.0
        for steps in (*_FIRST_LOOKS * [1], *_LATER_LOOKS * [_STEPS_A_LOOK]):
            run.step(steps)
            growth = max(growth, math.sqrt(_energy(run) / begin)) if begin else 0.0
            if not growth < GROWN:
                break
        return grown(growth, run.substeps)


def _energy(run: Simulation) -> float:
    seen = run.measure()
    return seen.kinetic_energy + seen.elastic_energy if seen.finite else math.inf


# Whether a scene keeps its energy as it moves, in any mode, at one dt.

# Max. energy gained without work, over the largest kinetic and elastic energy [1]; above the error
# of the scheme.
MOST_GAIN = 0.1
_MOVING_LOOKS = 25


def moving_probe(
        values: Mapping[str, Any], dt: float, *, seconds: float, most_steps: int = 10**9,
        check_stability: bool = True, context: Context | None = None) -> ProbeOutcome:
    """
    Run the scene of ``values`` with ``dt`` [s] and keep the books of its energy.

    It is unstable when it stops at the last finite state, or gains more than a tenth of its most
    kinetic and elastic energy from nothing. The growth is that share.

    :param seconds: simulated, and at least one step
    :param most_steps: after which the run ends in any case
    :param check_stability: False takes a dt that would be refused
    """
    scene = Scene({**values, 'dt': dt})
    steps = max(1, min(most_steps, math.ceil(seconds / dt - 1e-9)))
    try:
        run = Simulation(scene, context=context, check_stability=check_stability)
    except ClothSimError as error:
        return ProbeOutcome(REFUSED, detail=str(error))
    with closing(run):
        account = EnergyAccount(run)
        looks = min(steps, _MOVING_LOOKS)
        try:
            for look in range(looks):
                account.step((look + 1) * steps // looks - look * steps // looks)
                if not account.gained <= MOST_GAIN:
                    break
        except NonFiniteStateError as error:
            return ProbeOutcome(UNSTABLE, math.inf, run.substeps, str(error))
        stable = account.gained <= MOST_GAIN
        return ProbeOutcome(STABLE if stable else UNSTABLE, account.gained, run.substeps)


# A cloth that hangs from its top edge: at rest, and whether it stays in its plane.

_GRAVITY = 9.81
# Stiffness added to the diagonal, over that of hard edges [1]: the rows of a cloth without shear
# can slide, which makes the matrix singular.
_HOLD = 1e-9
_DENSE = 64
# Initial displacement out of the plane, over the spacing [1]; edges lengthen by its square only.
_OFFSET = 1e-5
_HANGING_STEPS = 200
_HANGING_LOOKS = 20


@dataclass(frozen=True)
class HangingCloth:
    """
    The rest state of a cloth in mode constraint, to first order in what its springs give.

    :param positions: (rows, cols, 3) [m], in the plane y = 0
    :param limit: the longest stable step [s] of explicit forces across the edges
    """

    positions: np.ndarray
    limit: float


def hanging_scene(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the cloth of ``values``, hanging upright from its top edge and left alone."""
    alone = {name: value for name, value in values.items()
             if not name.startswith(('pushes.', 'pin_moves.'))}
    pull = float(np.linalg.norm(Scene(values)['gravity'])) or _GRAVITY
    return {
        **alone, 'mode': 'constraint', 'gravity': [0.0, 0.0, -pull], 'start.pose': 'hanging',
        'start.jitter': 0.0, 'start.z': 0.0, 'pins': ['top_edge'], 'auto_substeps': False,
        'substeps': 1}


def hang(scene: Scene) -> HangingCloth:
    """
    Return how the cloth of a ``hanging_scene`` comes to rest.

    Edges pull across their direction with T / l for each metre. In a linearised step that pull is
    explicit, so it is stable while h < 2 / sqrt(largest eigenvalue of M^-1 K_geo)
    (docs/explanation/implicit_step.md), here of the motion out of the plane.
    """
    edges = edges_of(scene, always=scene['constraint.hard'])
    used = edges.of((*scene['constraint.hard'], *scene['constraint.springs']))
    rest = scene.rest_positions()
    flat = rest.reshape(-1, 3)
    free = ~scene.pinned_nodes().ravel()
    stiffness = _stiffness(scene, edges)[used]
    jacobian = edges.jacobian(edges.directions(flat), len(flat))[used]
    # The plane of the cloth: x and z of the free nodes.
    moves = np.repeat(free, 3) & np.tile([True, False, True], len(flat))
    masses = scene.node_mass * scene.node_shares.ravel()
    weight = (masses[:, None] * np.array(scene['gravity'])).ravel()[moves]
    within = jacobian[:, moves]
    matrix = within.T @ sparse.diags(stiffness) @ within
    matrix = matrix + sparse.diags(np.full(matrix.shape[0], _HOLD * stiffness.max()))
    shift = np.zeros(3 * len(flat))
    shift[moves] = splu(matrix.tocsc()).solve(weight)
    tension = stiffness * (jacobian @ shift)
    positions = flat + shift.reshape(-1, 3)
    pull = tension / edges.lengths(positions)[used]
    first, second = edges.first[used], edges.second[used]
    return HangingCloth(
        positions.reshape(rest.shape),
        2.0 / math.sqrt(_largest(first, second, pull, free, masses)))


def _stiffness(scene: Scene, edges: Edges) -> np.ndarray:
    """Return that of springs, and for hard edges one at which the cloth hardly gives [N/m]."""
    hard = 1e6 * max(
        scene.mass * float(np.linalg.norm(scene['gravity']))
        / min(scene.spacing), max(scene.stiffness(family) for family in FAMILIES))
    # Hard edges yield with the inverse masses of their ends: pinned ones have one of them.
    pinned = scene.pinned_nodes().ravel()
    half = pinned[edges.first] | pinned[edges.second]
    return np.where(
        edges.of(scene['constraint.hard']), edges.share * np.where(half, 2.0 * hard, hard),
        edges.stiffness)


def _largest(
        first: np.ndarray, second: np.ndarray, pull: np.ndarray, free: np.ndarray,
        masses: np.ndarray) -> float:
    """Return the largest eigenvalue of M^-1 K, K the graph of ``pull``, of free nodes."""
    count = len(free)
    matrix = sparse.coo_matrix(
        (np.concatenate((pull, pull, -pull, -pull)),
         (np.concatenate((first, second, first, second)),
          np.concatenate((first, second, second, first)))), shape=(count, count))
    roots = sparse.diags(masses[free]**-0.5)
    matrix = roots @ matrix.tocsr()[free][:, free] @ roots
    if matrix.shape[0] < _DENSE:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    # A fixed start: the same scene gives the same figure.
    start = np.random.default_rng(0).uniform(-1.0, 1.0, matrix.shape[0])
    return float(eigsh(matrix, k=1, which='LA', v0=start, return_eigenvectors=False)[0])


def hanging_probe(
        values: Mapping[str, Any], dt: float, *, context: Context | None = None) -> ProbeOutcome:
    """
    Step the hanging cloth of ``values`` by ``dt`` [s] and look how it moves out of its plane.

    What is unstable goes to and fro from step to step. So the amplitude is the RMS over the nodes
    of (y+ - 2 y + y-) / 4, and the growth is the largest over the RMS of y at the start. Shear
    edges push where the cloth narrows, and it buckles there: that is slow, and not counted.
    """
    scene = Scene({**hanging_scene(values), 'dt': dt})
    positions = hang(scene).positions.copy()
    offsets = np.random.default_rng(scene['start.seed']).uniform(
        -_OFFSET * min(scene.spacing), _OFFSET * min(scene.spacing), positions.shape[:2])
    positions[..., 1] += np.where(scene.pinned_nodes(), 0.0, offsets)
    with closing(Simulation(scene, context=context, stop_at_non_finite=False)) as run:
        run.set_state(positions, np.zeros_like(positions))
        begin = _rms(positions[..., 1])
        growth = 1.0
        for _ in range(_HANGING_LOOKS):
            run.step(_HANGING_STEPS // _HANGING_LOOKS - 2)
            growth = max(growth, _alternating(run) / begin)
            if not growth < GROWN:
                break
        return grown(growth, run.substeps)


def _alternating(run: Simulation) -> float:
    """Return the amplitude of what changes sign in each step [m]; make two steps."""
    places = []
    for steps in (0, 1, 1):
        run.step(steps)
        seen = run.snapshot()
        if not seen.finite:
            return np.inf
        places.append(seen.positions[..., 1].astype(float))
    return 0.25 * _rms(places[2] - 2.0 * places[1] + places[0])


def _rms(distances: np.ndarray) -> float:
    return float(np.sqrt(np.mean(distances**2)))
