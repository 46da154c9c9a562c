# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""State and health of a run, latched for late subscribers."""

from collections.abc import Sequence
from typing import Any

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import TimeBase
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_msgs.msg import KeyValue
from std_msgs.msg import Header


def state_of(
        simulation: Simulation, *, frame_id: str, run_state: str, preparing: str = '',
        compiled: int = 0, recording_path: str = '', epoch: int = 0) -> ClothState:
    """Return the state of ``simulation`` now; the rest as in state_message."""
    return state_message(
        frame_id=frame_id, sim_time=simulation.time, mode=simulation.mode,
        available_modes=simulation.available_modes, run_state=run_state,
        rows=simulation.scene.rows, cols=simulation.scene.cols, dt=simulation.dt,
        substeps=simulation.substeps, stability_limit=simulation.stability_limit,
        device=simulation.device, preparing=preparing, compiled=compiled,
        recording_path=recording_path, epoch=epoch)


def state_message(
        *, frame_id: str, sim_time: float, mode: str, available_modes: Sequence[str],
        run_state: str, rows: int, cols: int, dt: float, substeps: int, stability_limit: float,
        device: str, preparing: str = '', compiled: int = 0,
        recording_path: str = '', epoch: int = 0) -> ClothState:
    """
    Return the state of the node.

    :param run_state: ClothState.PREPARING, RUNNING, PAUSED or STOPPED
    :param dt: [s]
    :param stability_limit: longest stable substep of this mode [s]
    :param device: GL_RENDERER
    :param preparing: mode that is being compiled, empty when none is
    :param compiled: its programs that are ready
    :param recording_path: folder being written to, empty when not recording
    :param epoch: stamp of simulated time 0 [ns]
    """
    return ClothState(
        header=Header(stamp=stamp(sim_time, epoch), frame_id=frame_id),
        mode=mode,
        preparing=preparing,
        compiled=compiled,
        available_modes=list(available_modes),
        run_state=run_state,
        rows=rows,
        cols=cols,
        dt=dt,
        substeps=substeps,
        stability_limit=float(stability_limit),
        device=device,
        recording=bool(recording_path),
        recording_path=recording_path)


# The health of a run, in words.

LATE = 1.0          # [s] that stamps are behind; as long as between two diagnostics
FAR = 1e-3          # [m] that a body may be behind its frame: twice as much and it is seen
SLOW = 0.9          # share of the wanted real-time factor below which a run is slow
SAFE_MARGIN = 0.85  # what auto_substeps keeps
# Up to there a run is that of exact solves (docs/explanation/solver.md, Accuracy).
LOOSE_RESIDUAL = 5e-2

_Verdict = tuple[bytes, str, dict[str, Any]]  # level, words, values

OK = DiagnosticStatus.OK
WARN = DiagnosticStatus.WARN
ERROR = DiagnosticStatus.ERROR


def slow_pace(
        achieved: float, wanted: float, *, substeps: int, automatic: bool, mode: str) -> str:
    """
    Return that a run is too slow, and what makes it faster.

    :param achieved: simulated time per wall time
    :param wanted: the same as requested
    :param substeps: in each dt
    :param automatic: True where they follow from what is stable: a longer dt has more of them
    :param mode: its name
    """
    faster = 'a longer dt'
    if automatic and substeps > 1:
        # In mode constraint substeps follow how edges rotate.
        faster = 'a larger solver.tolerance' if mode == 'constraint' else 'softer springs'
    return (
        f'{achieved:.3g} x real time, below the target {wanted:.3g}: use fewer nodes, {faster}, '
        'another mode or a lower real_time_factor')


def diagnostics_message(
        snapshot: Snapshot | None, *, stamp: Time, node_name: str, device: str, paused: bool,
        real_time_factor: float, wanted_factor: float, automatic_substeps: bool, problem: str = '',
        recording_path: str = '', recording_error: str = '', recording_is_whole: bool = False,
        faults: int = 0, latest_fault: str = '', ignored: int = 0, source: str = 'own',
        behind: float = 0.0, time_problem: str = '',
        followers: Sequence[tuple[str, str, bool, float]] = (),
        waiting: Sequence[tuple[str, str]] = ()) -> DiagnosticArray:
    """
    Return the health of each part: device, pace, solver, stability, recorder and program.

    :param snapshot: None before the first mode is compiled
    :param stamp: of the present simulated time
    :param device: GL_RENDERER
    :param real_time_factor: simulated time per wall time, achieved
    :param wanted_factor: the same as requested, 0 for as fast as possible
    :param automatic_substeps: True where the substeps in a dt follow from what is stable
    :param problem: why the run has stopped, empty when it has not
    :param recording_path: folder being written to, empty when not recording
    :param recording_error: why the last recording has ended before it was stopped, empty when it
        has not
    :param recording_is_whole: True when it was completed all the same
    :param faults: unexpected errors since the start
    :param latest_fault: the last of them, in one line
    :param ignored: messages on topics that made no sense, since the start
    :param source: of the stamps, TimeBase.OWN or TimeBase.ROS
    :param behind: how far the cloth is behind the time that its stamps are of [s]
    :param time_problem: what is wrong with /clock; empty for nothing
    :param followers: of each body that follows a frame: its name, the frame, whether that is late,
        and how far the body is behind [m]
    :param waiting: bodies and cameras whose frame is not known yet, and the frame
    """
    findings = {'GL device': _device(snapshot, device)}
    if snapshot is not None:
        findings.update({
            'real-time factor': _pace(
                snapshot, paused, real_time_factor, wanted_factor, automatic_substeps,
                is_followed=source == TimeBase.ROS),
            'solver': _solver(snapshot),
            'stability': _stability(snapshot, problem, automatic_substeps),
            'pins': _pins(snapshot)})
    findings['time'] = _time(source, behind, time_problem, paused)
    if followers or waiting:
        findings['followed frames'] = _followed(followers, waiting)
    findings['recorder'] = _recorder(recording_path, recording_error, recording_is_whole)
    findings['program'] = _program(faults, latest_fault, ignored)
    return DiagnosticArray(
        header=Header(stamp=stamp),
        status=[
            DiagnosticStatus(
                name=f'{node_name}: {name}', level=level, message=text, hardware_id=device,
                values=[KeyValue(key=key, value=_text(value)) for key, value in values.items()])
            for name, (level, text, values) in findings.items()])


def _text(value: object) -> str:
    return f'{value:.6g}' if isinstance(value, float) else str(value)


def _device(snapshot: Snapshot | None, device: str) -> _Verdict:
    text = device if snapshot is not None else f'{device} is compiling the first shaders'
    return OK, text, {'renderer': device}


def _pace(
        snapshot: Snapshot, paused: bool, achieved: float, wanted: float, automatic: bool, *,
        is_followed: bool) -> _Verdict:
    values = {'achieved': float(achieved), 'wanted': float(wanted), 'paused': paused}
    if paused:
        return OK, 'paused', values
    if is_followed:
        return OK, f'{achieved:.3g} x real time, at the pace of /clock', values
    if wanted == 0.0:
        return OK, f'{achieved:.3g} x real time, as fast as possible', values
    if achieved < SLOW * wanted:
        return WARN, slow_pace(
            achieved, wanted, substeps=snapshot.substeps, automatic=automatic,
            mode=snapshot.mode), values
    return OK, f'{achieved:.3g} x real time', values


def _solver(snapshot: Snapshot) -> _Verdict:
    values = {
        'mode': snapshot.mode,
        'iterations': int(snapshot.solver_iterations),
        'residual': float(snapshot.solver_residual),
        'tolerance reached': bool(snapshot.solver_reached),
        'active constraints': int(snapshot.active_constraints),
        'listed edges': int(snapshot.listed_edges),
        'limit rounds': int(snapshot.limit_rounds),
        'limit unreached': int(snapshot.limit_unreached),
    }
    if snapshot.limit_unreached:
        return WARN, (
            f'{snapshot.limit_unreached} substeps of a step missed the tolerance of the strain '
            f'limit after {snapshot.limit_rounds} rounds: use a shorter dt'), values
    if snapshot.solver_iterations == 0 and snapshot.listed_edges:
        return OK, (
            f'{snapshot.listed_edges} edges near their limit in {snapshot.limit_rounds} rounds'
        ), values
    if snapshot.solver_iterations == 0:
        return OK, f'{snapshot.mode} has nothing to solve', values
    text = f'residual {snapshot.solver_residual:.2g} in {snapshot.solver_iterations} iterations'
    if not snapshot.solver_reached:
        return WARN, (
            f'{text}, above what solver.tolerance asks for: raise solver.max_iterations, or use '
            'a shorter dt'), values
    # Written so that a residual that is not a number warns.
    if not snapshot.solver_residual <= LOOSE_RESIDUAL:
        return WARN, (
            f'{text} is above {LOOSE_RESIDUAL:g}: lower solver.tolerance, or use a shorter dt'
        ), values
    return OK, text, values


def _stability(snapshot: Snapshot, problem: str, automatic: bool) -> _Verdict:
    margin = float(snapshot.stability_margin)
    values = {
        'margin': margin,
        'dt': float(snapshot.dt),
        'substeps': int(snapshot.substeps),
        'max strain': float(snapshot.max_strain),
        'settling': bool(snapshot.settling),
        'settling work': float(snapshot.settling_work),
        'air margin': float(snapshot.air_margin),
        'total energy': float(snapshot.total_energy),
        'surface contact held': bool(snapshot.surface_contact_held),
    }
    if problem:
        return ERROR, problem, values
    if not snapshot.lengths_are_held:
        way_out = (
            'the cloth came like that, and a limit is closing in on it' if snapshot.settling
            else 'use a shorter dt, or smaller forces')
        return WARN, (
            f'edges deviate by {snapshot.max_strain:.2g} from their length, and '
            f'{snapshot.strain_bound:.2g} is allowed: {way_out}'), values
    if not snapshot.surface_contact_held:
        return WARN, (
            f'the cloth passes through itself or a thin collider, or is inside a collider by '
            f'{snapshot.deepest_node:.2g} m, or layers overlap by '
            f'{snapshot.layer_overlap:.2g} of their thickness and ways were cut by '
            f'{snapshot.largest_cut:.2g} m: use a shorter dt, or begin with layers apart'), values
    if snapshot.air_margin > 1.0 + 1e-3:
        way_out = 'use a shorter dt'
        if automatic and snapshot.solves:
            way_out = f'raise constraint.max_substeps, or {way_out}'
        return WARN, (
            f'air acts with less than its force, as a substep is {snapshot.air_margin:.3g} times '
            f'as long as it may be for that: {way_out}'), values
    if snapshot.settling:
        return OK, (
            'a limit is closing in on edges that came longer or shorter, and has done '
            f'{snapshot.settling_work:.3g} J of work'), values
    if snapshot.solves:
        return _turns(margin, values, automatic)
    text = f'a substep is {margin:.3g} times the stability limit'
    if margin > 1.0:
        return ERROR, f'{text}: use a shorter dt, or auto_substeps: true', values
    if margin > SAFE_MARGIN + 1e-3:
        return WARN, f'{text}, above the safe {SAFE_MARGIN}: use a shorter dt', values
    return OK, text, values


def _pins(snapshot: Snapshot) -> _Verdict:
    values = {'stalled': int(snapshot.stalled_pins)}
    if snapshot.stalled_pins:
        return WARN, (
            f'{snapshot.stalled_pins} moving pins are stalled by edge forces above pin.max_force: '
            'let the cloth follow, or choose nearer targets'), values
    return OK, 'no moving pin is stalled', values


def _turns(margin: float, values: dict[str, Any], automatic: bool) -> _Verdict:
    text = f'edges rotate by {margin**2:.3g} times the accurate limit per substep'
    if margin > 1.0 + 1e-3:
        way_out = 'raise constraint.max_substeps' if automatic else 'set auto_substeps: true'
        return WARN, f'{text}: {way_out}, or use a shorter dt', values
    return OK, text, values


def _time(source: str, behind: float, problem: str, paused: bool) -> _Verdict:
    values = {'source': source, 'behind [s]': float(behind)}
    if problem:
        return WARN, problem, values
    if behind > LATE and not paused:
        clock = '/clock' if source == TimeBase.ROS else 'the wall clock'
        return WARN, (
            f'stamps are {behind:.3g} s behind {clock}, as the cloth is slower: use fewer nodes, '
            'a longer dt or another mode, or pause and resume to leave that time out'), values
    return OK, 'stamps follow /clock' if source == TimeBase.ROS else 'own time', values


def _followed(
        followers: Sequence[tuple[str, str, bool, float]],
        waiting: Sequence[tuple[str, str]]) -> _Verdict:
    values: dict[str, Any] = {
        f'{name}, behind {frame} [m]': float(behind) for name, frame, _, behind in followers}
    missing = [frame for _, frame in waiting] + [
        frame for _, frame, is_late, _ in followers if is_late]
    if missing:
        return WARN, (
            f'{", ".join(sorted(set(missing)))} have not come on /tf: start what publishes them, '
            'or, for a body, call ~/follow_grasp or ~/follow_collider with an empty frame'), values
    slow = [name for name, _, _, behind in followers if behind > FAR]
    if slow:
        return WARN, (
            f'{", ".join(slow)} are behind their frames, which are faster than max_speed: move '
            'the frames more slowly, or give a higher one'), values
    return OK, f'{len(followers)} bodies follow frames of tf', values


def _recorder(path: str, error: str, is_whole: bool) -> _Verdict:
    values = {'path': path}
    if error:
        return WARN if is_whole else ERROR, error, values
    return OK, f'recording to {path}' if path else 'not recording', values


def _program(faults: int, latest: str, ignored: int) -> _Verdict:
    values = {'unexpected errors': faults, 'latest': latest, 'ignored messages': ignored}
    if faults:
        return WARN, (
            f'{faults} unexpected errors, the latest in {latest}: report it with its trace from '
            'the log'), values
    return OK, 'no unexpected error', values
