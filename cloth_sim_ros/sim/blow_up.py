# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""When a state became non-finite, why, and what to change."""

from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.stability import safe_substep
from cloth_sim_ros.sim.state import MOST_MAGNITUDE
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.strips import Strips
import numpy as np

# Of the shortest spacing: a node that moves further in a substep has left what its springs know.
_FAR = 0.5
# A strain that no cloth was laid out for.
_OVERSTRETCHED = 10.0


class BoundsCheck:
    """Runs bounds_check.comp; compiles it when it is first asked."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate its result."""
        self._strips = Strips(layout, 1)
        self._program = SceneProgram('bounds_check.comp', scene, layout, Strips.defines())

    def passes(self, state: State) -> bool:
        """Return whether nothing of ``state`` is NaN, infinite or beyond MOST_MAGNITUDE."""
        program = self._program.use()
        state.bind_in()
        self._strips.dispatch(program)
        return bool(self._strips.largest()[0] == 0.0)

    def delete(self) -> None:
        """Give pass and result back."""
        self._strips.delete()
        self._program.delete()


def explain(
        scene: Scene, lost: np.ndarray, records: np.ndarray, *, mode: str, substeps: int,
        longest_substep: float, stability_limit: float, steps: int,
        gained_speed: float) -> NonFiniteStateError:
    """
    Return the error that tells when, where, why, and what to change.

    :param lost: records of the state that is not finite
    :param records: of the last finite one, which is kept
    :param substeps: of the step that led from one to the other
    :param longest_substep: that the mode takes of a cloth at rest [s]
    :param steps: made until the state that is kept
    :param gained_speed: by pushes in the step after it [m/s]
    """
    speeds = _lengths(records, 'vx', 'vy', 'vz')
    # Of the nodes that were lost, the fastest: a blow-up spreads from node to node.
    row, col = (int(at) for at in np.unravel_index(
        np.argmax(np.where(_is_lost(lost), speeds, -1.0)), speeds.shape))
    time = steps * scene['dt']
    cause, way_out = _cause(
        scene, longest_substep, stability_limit, float(speeds.max()),
        float(records['strain'].max()), gained_speed)
    return NonFiniteStateError(
        f'the state became non-finite in the step from t = {time:.6g} s, first at node '
        f'({row}, {col}), in mode {mode} with substeps of {scene["dt"] / substeps:.3g} s: '
        f'positions and velocities must stay below {MOST_MAGNITUDE:g} m and m/s, but {cause}; '
        f'the state at {time:.6g} s is kept: {way_out}', steps=steps, node=(row, col))


def _cause(
        scene: Scene, substep: float, stability_limit: float, speed: float, strain: float,
        gained_speed: float) -> tuple[str, str]:
    reach = _FAR * min(scene.spacing)
    safe_dt = f'{safe_substep(scene) * scene["substeps"]:.3g}'
    if substep > stability_limit:
        return (
            f'the substep is {substep / stability_limit:.3g} times the stability limit',
            f'set dt <= {safe_dt}, or auto_substeps: true')
    if gained_speed * substep > reach:
        return (
            f'a push accelerated nodes by up to {gained_speed:.3g} m/s, more than {reach:.3g} m '
            'per substep', 'push with less force, or use a larger mass')
    if speed * substep > reach:
        return (
            f'the fastest node moved at {speed:.3g} m/s, more than {reach:.3g} m per '
            'substep', 'push or start it more gently, or set a smaller dt')
    if strain > _OVERSTRETCHED:
        return (
            f'a spring had the strain {strain:.3g}',
            'stretch it less, or use stiffer springs or more damping')
    if substep > safe_substep(scene):
        return (
            'substeps of that length are stable for a flat cloth, but not for a folded one',
            f'set dt <= {safe_dt}, or auto_substeps: true')
    return (
        f'the fastest node moved at {speed:.3g} m/s and the largest strain was {strain:.3g}',
        f'set dt <= {min(substep, scene["dt"]) / 2.0:.3g}, or use softer springs or a larger mass')


def _is_lost(records: np.ndarray) -> np.ndarray:
    # Written so that what is no number is lost.
    return ~np.logical_and.reduce([
        np.abs(records[name]) < MOST_MAGNITUDE for name in ('x', 'y', 'z', 'vx', 'vy', 'vz')])


def _lengths(records: np.ndarray, *names: str) -> np.ndarray:
    return np.sqrt(sum(records[name].astype(np.float64)**2 for name in names))
