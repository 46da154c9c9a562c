# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make steps, stop at the last finite state when one leads out of all bounds, and say why."""

from collections.abc import Callable
from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
from typing import Any
from typing import NoReturn
from typing import Protocol

from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.observer import Observer
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.stability import safe_substep
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import MOST_MAGNITUDE
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Max. displacement of a node in a substep over the shortest spacing [1]: beyond 1/2,
# neighbours can pass each other.
_FAR = 0.5
# Makes up to so many steps, from the one of a number on; returns how many it has made.
StepsFrom = Callable[[int, int, Stop], int]
# Rotation of edges in a substep over the accurate one [1]; below it, rotation is no cause.
_ROUNDING = 1e-3
# Strain above which a cloth counts as overstretched [1]: ten times its length, as no fabric is.
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
        """Release pass and result."""
        self._strips.delete()
        self._program.delete()


@dataclass(frozen=True)
class StepReport:
    """
    How a mode has made a step.

    :param substeps: of dt
    :param stability_limit: longest stable substep [s]; infinite for an implicit step
    :param turn_margin: of an implicit step, the substep over the longest in which edges turn by
        no more than they should
    :param solves: linear solves
    :param iterations: most of a solve
    :param solver_reached: False when one of them stopped before ``solver.tolerance``, or edges at
        their limit were not found
    """

    substeps: int
    stability_limit: float
    turn_margin: float = 0.0
    solves: int = 0
    iterations: int = 0
    solver_reached: bool = True

    @property
    def is_implicit(self) -> bool:
        """Return whether it was an implicit step."""
        return self.solves > 0


def report_of(mode: Mode) -> StepReport:
    """Return how ``mode`` has made the last step."""
    found = mode.report()
    return StepReport(
        mode.substeps, mode.stability_limit, mode.substep_margin, found.get('solves', 0),
        found.get('solver_iterations', 0), found.get('solver_reached', True))


def explain(
        scene: Scene, lost: np.ndarray, records: np.ndarray, *, mode: str, step: StepReport,
        steps: int, gained_speed: float) -> NonFiniteStateError:
    """
    Return the error with time, node, cause, and what to change.

    :param lost: records of the state that is not finite
    :param records: of the last finite one, which is kept
    :param step: that led from one to the other
    :param steps: made until the state that is kept
    :param gained_speed: by pushes in the step after it [m/s]
    """
    speeds = _lengths(records, 'vx', 'vy', 'vz')
    # The fastest of the lost nodes: a blow-up spreads from node to node.
    row, col = (int(at) for at in np.unravel_index(
        np.argmax(np.where(_is_lost(lost), speeds, -1.0)), speeds.shape))
    time = steps * scene['dt']
    cause, way_out = _cause(
        scene, mode, step, float(speeds.max()), float(records['strain'].max()), gained_speed)
    return NonFiniteStateError(
        f'the state became non-finite in the step from t = {time:.6g} s, first at node '
        f'({row}, {col}), in mode {mode} with substeps of {scene["dt"] / step.substeps:.3g} s: '
        f'positions and velocities must stay below {MOST_MAGNITUDE:g} m and m/s, but {cause}; '
        f'the state at {time:.6g} s is kept: {way_out}', steps=steps, node=(row, col))


def _cause(
        scene: Scene, mode: str, step: StepReport, speed: float, strain: float,
        gained_speed: float) -> tuple[str, str]:
    substep = scene['dt'] / step.substeps
    reach = _FAR * min(scene.spacing)
    if substep > step.stability_limit:
        return (
            f'the substep is {substep / step.stability_limit:.3g} times the stability limit',
            _shorter_springs(scene))
    if gained_speed * substep > reach:
        return (
            f'a push accelerated nodes by up to {gained_speed:.3g} m/s, more than {reach:.3g} m '
            'per substep', 'push with less force, or use a larger mass')
    most = scene['solver.max_iterations']
    if step.is_implicit and not step.solver_reached and step.iterations >= most:
        return (
            f'solves stopped at solver.max_iterations {most}, above solver.tolerance '
            f'{scene["solver.tolerance"]:g}',
            f'raise solver.max_iterations, or set dt <= {scene["dt"] / 2.0:.3g}')
    if step.is_implicit and step.turn_margin > 1.0 + _ROUNDING:
        return (
            f'edges rotated by {step.turn_margin**2:.3g} times the accurate limit per substep',
            _more_turns(scene))
    if step.is_implicit and not step.solver_reached and mode == 'adaptive':
        return (
            'the edges at their limit were not found',
            f'set dt <= {scene["dt"] / 2.0:.3g}, or raise adaptive.threshold')
    if speed * substep > reach:
        return (
            f'the fastest node moved at {speed:.3g} m/s, more than {reach:.3g} m per '
            'substep', 'push or start it more gently, or set a smaller dt')
    if strain > _OVERSTRETCHED:
        return (
            f'an edge had the strain {strain:.3g}',
            'stretch it less, or set a smaller dt' if step.is_implicit
            else 'stretch it less, or use stiffer springs or more damping')
    if not step.is_implicit and substep > safe_substep(scene):
        return (
            'substeps of that length are stable for a flat cloth, but not for a folded one',
            _shorter_springs(scene))
    softer = 'a larger constraint.strain' if step.is_implicit else 'softer springs'
    return (
        f'the fastest node moved at {speed:.3g} m/s and the largest strain was {strain:.3g}',
        f'set dt <= {min(substep, scene["dt"]) / 2.0:.3g}, or use {softer} or a larger mass')


def _shorter_springs(scene: Scene) -> str:
    """Return the remedy for substeps that are too long for springs."""
    way_out = f'set dt <= {safe_substep(scene) * scene["substeps"]:.3g}'
    # With them substeps are short enough; a dt of that length would not be needed.
    return way_out if scene['auto_substeps'] else f'{way_out}, or auto_substeps: true'


def _more_turns(scene: Scene) -> str:
    """Return the remedy for substeps in which edges turn too far."""
    other = (
        'raise constraint.max_substeps' if scene['auto_substeps'] else 'auto_substeps: true')
    if scene['constraint.newton_iterations'] == 1:
        other = f'constraint.newton_iterations: 2, or {other}'
    return f'set dt <= {scene["dt"] / 2.0:.3g}, or {other}'


def _is_lost(records: np.ndarray) -> np.ndarray:
    # Written so that NaN counts as lost.
    return ~np.logical_and.reduce([
        np.abs(records[name]) < MOST_MAGNITUDE for name in ('x', 'y', 'z', 'vx', 'vy', 'vz')])


def _lengths(records: np.ndarray, *names: str) -> np.ndarray:
    return np.sqrt(sum(records[name].astype(np.float64)**2 for name in names))


# Make steps, and stop at the last finite state when one leads out of all bounds.

def _nothing(steps: int) -> None:
    pass


class Restorable(Protocol):
    """What steps change."""

    def keep(self) -> Any:
        """Return what ``restore`` needs to come back to this moment."""

    def restore(self, kept: Any) -> None:
        """Go back to the moment of ``keep``, the latest one."""


class GuardedSteps:
    """
    Check the state at the end of each batch of steps, and now and then within.

    When a check fails, the steps since the last good one are made again, each with a check of
    its own, and the state goes back to the last that passes. What the mode carries
    over from step to step is reset.

    :param guarded: False makes further steps of a non-finite state
    """

    def __init__(
            self, scene: Scene, layout: Layout, observer: Observer, state: State,
            guarded: bool = True) -> None:
        """Allocate the buffers of the check."""
        self._scene = scene
        self._dt: float = scene['dt']
        self._observer = observer
        self._state = state
        self._guarded = guarded
        self.check = BoundsCheck(scene, layout)

    def make(
            self, first: int, count: int, step: StepsFrom, mode: Mode,
            loads: Loads, others: Sequence[Restorable] = (), *,
            is_due: Callable[[], bool] = never, stop: Stop = never,
            settle: Callable[[int], None] = _nothing) -> None:
        """
        Make up to ``count`` steps from a state that is finite.

        :param first: number of the first step, counted from 0 at the start of the run
        :param step: makes some steps from that of a number on, by ``mode``; returns how many
        :param loads: those that ``step`` uses
        :param others: what else ``step`` changes
        :param is_due: asked after each step: True makes it the last
        :param stop: asked before and within steps: True abandons those since the last check
        :param settle: called with the number of steps made, when they have passed a check
        :raises NonFiniteStateError: after going back to the last finite state
        :raises StepAbandoned: as ``stop`` has asked, after going back to the last state checked
        """
        parts: tuple[Restorable, ...] = (self._state, loads, *others)
        kept = _keep(parts)
        since = number = first
        substeps = 0
        while number < first + count:
            most = -(-(mode.checked_substeps - substeps) // mode.substeps)
            try:
                leave_if(stop)
                made = step(number, min(most, first + count - number), stop)
            except BaseException:
                # Abandoned, interrupted, or the device has failed: no half step is left behind.
                _go_back(parts, kept, mode)
                raise
            number += made
            substeps += made * mode.substeps
            ends = number == first + count or is_due()
            if not ends and substeps < mode.checked_substeps:
                continue
            if self._guarded and not self.check.passes(self._state):
                _go_back(parts, kept, mode)
                self._step_to_the_last_finite(since, number, step, mode, loads, parts)
            since, substeps = number, 0
            settle(since)
            if ends:
                return
            kept = _keep(parts)

    def delete(self) -> None:
        """Release everything."""
        self.check.delete()

    def _step_to_the_last_finite(
            self, begin: int, end: int, step: StepsFrom, mode: Mode,
            loads: Loads, parts: Sequence[Restorable]) -> NoReturn:
        before: StepReport | None = None
        most = self._scene['solver.max_iterations']
        for number in range(begin, end):
            kept = _keep(parts)
            step(number, 1, never)
            made = report_of(mode)
            if self.check.passes(self._state):
                before = made
                continue
            # With NaN in the state no solve reaches its tolerance: the previous step says more.
            if before is not None and before.is_implicit == made.is_implicit:
                made = replace(before, substeps=made.substeps)
            else:
                made = replace(made, solver_reached=made.iterations < most or made.solver_reached)
            time = number * self._dt
            lost = self._look()
            _go_back(parts, kept, mode)
            raise explain(
                self._scene, lost, self._look(), mode=mode.name, step=made, steps=number,
                gained_speed=loads.speed_gained(time, time + self._dt))
        raise NonFiniteStateError(
            f'the state became non-finite before t = {end * self._dt:.6g} s in mode {mode.name}, '
            f'but not when the steps since {begin * self._dt:.6g} s were repeated without what '
            'the mode had carried over from earlier ones: continue from there, or set a smaller '
            'dt',
            steps=end)

    def _look(self) -> np.ndarray:
        return self._observer.record(self._state, Forcing(self._scene['gravity']), None)[1]


def _keep(parts: Sequence[Restorable]) -> list[Any]:
    return [part.keep() for part in parts]


def _go_back(parts: Sequence[Restorable], kept: Sequence[Any], mode: Mode) -> None:
    for part, its_own in zip(parts, kept):
        part.restore(its_own)
    mode.forget()
