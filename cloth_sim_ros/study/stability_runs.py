# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs of the stability study, points of its maps and edges by bisection, and its tables."""

from collections import Counter
from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.model.stability import any_shape_limit
from cloth_sim_ros.sim.model.stability import spring_substeps
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.scene_values import scaled_stiffness
from cloth_sim_ros.study.stability_probes import hang
from cloth_sim_ros.study.stability_probes import hanging_probe
from cloth_sim_ros.study.stability_probes import hanging_scene
from cloth_sim_ros.study.stability_probes import moving_probe
from cloth_sim_ros.study.stability_probes import ProbeOutcome
from cloth_sim_ros.study.stability_probes import REFUSED
from cloth_sim_ros.study.stability_probes import rest_probe
from cloth_sim_ros.study.stability_probes import rest_scene
from cloth_sim_ros.study.stability_probes import STABLE
from cloth_sim_ros.study.stability_probes import UNSTABLE
from cloth_sim_ros.study.workers import process_context
import numpy as np
from scipy import sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh

_FACTOR = 2.0
_MOST_WIDENINGS = 8
_DENSE = 64
_TOLERANCE = 1e-4
# Simulated time of a moving scene [s]: long enough for its first fall and for an instability.
MOVING_SECONDS = 0.5
_MOST_STEPS, _MOST_IMPLICIT_STEPS = 2000, 300
_LONGEST_DT = 1.0


@dataclass(frozen=True)
class Edge:
    """
    The longest step seen to be stable and the shortest seen not to be [s].

    :param stable: 0 where none was stable
    :param unstable: infinite where all were
    """

    stable: float
    unstable: float

    @property
    def middle(self) -> float:
        """Return the edge, the geometric mean of both [s]; 0 or infinite where there is none."""
        if self.stable == 0.0 or math.isinf(self.unstable):
            return self.stable and self.unstable
        return math.sqrt(self.stable * self.unstable)


def bisect_edge(
        is_stable: Callable[[float], bool], guess: float, *, width: float = 0.005,
        longest: float = math.inf) -> Edge:
    """
    Return the edge of ``is_stable``, a function of the step, which lies near ``guess`` [s].

    :param width: of what is left between both sides, over the edge
    :param longest: step that is tried [s]
    """
    stable, unstable = 0.0, math.inf
    step = min(guess / math.sqrt(_FACTOR), longest)
    for _ in range(_MOST_WIDENINGS):
        if is_stable(step):
            stable = step
            if math.isfinite(unstable) or step >= longest:
                break
            step = min(step * _FACTOR, longest)
        else:
            unstable = step
            if stable:
                break
            step /= _FACTOR
    while stable and math.isfinite(unstable) and unstable > (1.0 + width) * stable:
        middle = math.sqrt(stable * unstable)
        if is_stable(middle):
            stable = middle
        else:
            unstable = middle
    return Edge(stable, unstable)


def lattice_limit(scene: Scene) -> float:
    """
    Return the longest stable substep [s] of the flat cloth of ``scene``, nothing held.

    ``stability_limit`` has waves of an endless lattice in a closed form; this has the matrices of
    the springs themselves, K = J^T k J and C = J^T k_d J. A wave turns unstable by changing its
    sign in each step, so the limit is the least h at which h^2 K + 2 h C has the eigenvalue 4 m.
    """
    closed = stability_limit(scene)
    if math.isinf(closed):
        return closed
    edges = edges_of(scene)
    flat = scene.rest_positions().reshape(-1, 3)
    jacobian = edges.jacobian(edges.directions(flat), len(flat))
    stiff, damped = (
        jacobian.T @ sparse.diags(weights) @ jacobian
        for weights in (edges.stiffness, edges.damping))

    # Over the masses: M^-1/2 K M^-1/2 has the eigenvalues of M^-1 K.
    roots = sparse.diags(np.repeat(scene.node_shares.ravel()**-0.5, 3))
    stiff, damped = roots @ stiff @ roots, roots @ damped @ roots

    def excess(step: float) -> float:
        return _largest(step**2 * stiff + 2.0 * step * damped) / (4.0 * scene.node_mass) - 1.0

    # Never below the closed form, as borders take springs away, nor below the bound of a fabric.
    longest = closed
    while excess(longest) < 0.0:
        longest *= 2.0
    return closed if longest == closed else float(
        brentq(excess, 0.5 * longest, longest, rtol=_TOLERANCE))


def _largest(matrix: sparse.spmatrix) -> float:
    if matrix.shape[0] < _DENSE:
        return float(np.linalg.eigvalsh(matrix.toarray())[-1])
    # A fixed start: the same scene gives the same figure.
    start = np.random.default_rng(0).uniform(-1.0, 1.0, matrix.shape[0])
    return float(eigsh(
        matrix, k=1, which='LA', tol=_TOLERANCE, v0=start, return_eigenvectors=False)[0])


def run_point(
        scene: Mapping[str, Any], *, factor: float, dt: float, forced: bool) -> dict[str, Any]:
    """
    Return what one point of the map of a mode came to.

    :param scene: scene parameters, the mode among them
    :param factor: that all stiffness is multiplied by
    :param dt: [s]
    :param forced: one step a dt, whatever the limit, of the cloth at rest; otherwise the scene as
        it moves, in the substeps that the project chooses by itself
    """
    context = process_context()
    values = with_stiffness(scene, factor)
    if forced:
        probe = hanging_probe if _is_implicit(values) else rest_probe
        outcome = probe(values, dt, context=context)
        refused = _is_refused(values, dt)
    else:
        outcome = _moving({**values, 'auto_substeps': True}, dt, context)
        refused = outcome.outcome == REFUSED
    return {**outcome.as_dict(), 'refused': refused, 'device': context.device}


def run_edge(scene: Mapping[str, Any], *, probe: str, vary: str, value: float) -> dict[str, Any]:
    """
    Return where ``scene`` ceases to be stable, found by bisection, and where it should.

    :param probe: rest or moving with springs, hanging in an implicit mode
    :param vary: what of the scene was varied, and to what ``value``; told, not used
    """
    context = process_context()
    limit = predicted_limit(scene, scene['mode'])
    result = {'predicted': limit}
    if probe == 'rest':
        result['lattice'] = lattice_limit(Scene(rest_scene(scene)))
    if probe == 'moving':
        result['any_shape'] = any_shape_limit(Scene(scene))
    edge = bisect_edge(
        lambda dt: _probed(scene, probe, dt, context).outcome == STABLE, limit,
        longest=_LONGEST_DT, width=0.02 if probe == 'moving' else 0.005)
    measured = edge.middle if math.isfinite(edge.middle) else None
    return {
        **result, 'stable': edge.stable,
        'unstable': edge.unstable if math.isfinite(edge.unstable) else None,
        'measured': measured, 'ratio': measured / limit if measured else None,
        'device': context.device}


def with_stiffness(values: Mapping[str, Any], factor: float) -> dict[str, Any]:
    """Return the scene of ``values`` with all springs ``factor`` times as stiff."""
    return {**values, **scaled_stiffness(Scene(values), factor)}


def predicted_limit(values: Mapping[str, Any], mode: str) -> float:
    """Return the longest stable step [s] in ``mode``, from its closed form."""
    if AVAILABLE[mode].is_implicit:
        return hang(Scene(hanging_scene(values))).limit
    return stability_limit(Scene(rest_scene(values)))


def _probed(
        values: Mapping[str, Any], probe: str, dt: float, context: Context) -> ProbeOutcome:
    if probe == 'moving':
        forced = {**values, 'auto_substeps': False, 'substeps': 1}
        return _moving(forced, dt, context, check_stability=False)
    return (hanging_probe if probe == 'hanging' else rest_probe)(values, dt, context=context)


def _moving(
        values: Mapping[str, Any], dt: float, context: Context,
        check_stability: bool = True) -> ProbeOutcome:
    is_implicit = _is_implicit(values)
    if is_implicit:
        # Hard edges that begin off their length bring energy with them.
        values = {**values, 'start.jitter': 0.0}
    return moving_probe(
        values, dt, seconds=MOVING_SECONDS,
        most_steps=_MOST_IMPLICIT_STEPS if is_implicit else _MOST_STEPS,
        check_stability=check_stability, context=context)


def _is_implicit(values: Mapping[str, Any]) -> bool:
    return AVAILABLE[values['mode']].is_implicit


def _is_refused(values: Mapping[str, Any], dt: float) -> bool:
    """Return whether the scene is refused with ``dt``, one step a dt, when nobody insists."""
    if _is_implicit(values):
        return False
    try:
        spring_substeps(Scene({**rest_scene(values), 'dt': dt}), values['mode'])
    except ClothSimError:
        return True
    return False


# The tables of the stability study.

PROBES = {'rest': 'at rest', 'hanging': 'hanging', 'moving': 'moving'}


def edge_table(results: Sequence[Result]) -> str:
    """Return the edges as a table in Markdown: predicted, measured, and their ratio."""
    lines = [
        '| mode | cloth | varied | value | predicted [s] | this lattice [s] | measured [s] '
        '| measured / predicted |', '|---|---|---|---|---|---|---|---|']
    for result in results:
        settings, found = result.settings, result.values
        start = (f'| {result.scene["mode"]} | {PROBES[settings["probe"]]} | {settings["vary"]} '
                 f'| {settings["value"]:g} |')
        if not result.is_done:
            lines.append(f'{start} | | {result.outcome}: {result.reason} | |')
            continue
        lattice = f'{found["lattice"]:.4g}' if 'lattice' in found else ''
        lines.append(
            f'{start} {found["predicted"]:.4g} | {lattice} | '
            + (f'{found["measured"]:.4g} | {found["ratio"]:.3f} |' if found['measured']
               else f'stable at {found["stable"]:.4g} | |'))
    return '\n'.join(lines) + '\n'


def map_table(results: Sequence[Result]) -> str:
    """Return how many points of each map are stable, unstable, refused."""
    lines = ['| mode | steps | stable | unstable | refused |', '|---|---|---|---|---|']
    for mode in MODES:
        for forced in (True, False):
            counts = Counter(
                result.values['outcome'] if result.is_done else result.outcome
                for result in points_of(results, mode, forced))
            others = ', '.join(
                f'{count} {name}' for name, count in counts.items()
                if name not in (STABLE, UNSTABLE, REFUSED))
            lines.append(
                f'| {mode} | {steps_of(mode, forced)} | {counts[STABLE]} | {counts[UNSTABLE]} '
                f'| {counts[REFUSED]} |'
                + (f' {others}' if others else ''))
    return '\n'.join(lines) + '\n'


def steps_of(mode: str, forced: bool) -> str:
    """Return how the steps of a map are made, and what its cloth does."""
    if not forced:
        return 'by default, moving'
    return f'one step a dt, {"hanging" if AVAILABLE[mode].is_implicit else "at rest"}'


def points_of(results: Sequence[Result], mode: str, forced: bool) -> list[Result]:
    """Return the points of one map."""
    return [result for result in results
            if result.scene['mode'] == mode and result.settings['forced'] == forced]
