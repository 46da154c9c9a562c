# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording in a few numbers, and those in words; several as a Markdown table."""

from collections.abc import Iterable
from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
import numpy as np

_HEAD = (
    'run', 'dt [s]', 'substeps a dt', 'largest strain', 'beyond its limit',
    'peak kinetic energy [J]', 'end', 'wall time [s]')


@dataclass(frozen=True)
class RunOutcome:
    """
    Peaks are those of the recorded frames.

    :param end: time of the last frame [s]
    :param dt: [s]
    :param substeps: of a dt, mean over the frames that moved on
    :param max_strain: largest of any structural or shear spring
    :param kinetic_energy: largest [J]
    :param stability_margin: largest; above 1 the substep is longer than is stable
    :param wall_seconds: spent on the steps
    :param device: GL_RENDERER
    :param stopped: True when the next state was not finite
    """

    end: float = 0.0
    dt: float = 0.0
    substeps: float = 0.0
    max_strain: float = 0.0
    kinetic_energy: float = 0.0
    stability_margin: float = 0.0
    wall_seconds: float = 0.0
    device: str = ''
    stopped: bool = False

    @classmethod
    def of(cls, run: Run) -> 'RunOutcome':
        """Return the outcome of ``run``, which was recorded without a reset."""
        columns = run.columns
        dt = float(columns['dt'][-1])
        steps = np.round(np.diff(columns['time']) / dt)
        moved = steps > 0.0
        return cls(
            end=float(columns['time'][-1]), dt=dt,
            substeps=float(columns['substeps'][1:][moved].mean()) if moved.any() else 0.0,
            max_strain=float(columns['max_strain'].max()),
            kinetic_energy=float(columns['kinetic_energy'].max()),
            stability_margin=float(columns['stability_margin'].max()),
            wall_seconds=float(np.sum(steps * columns['step_wall_time'][1:])),
            device=run.device, stopped=run.stopped)


def outcome_table(rows: Iterable[tuple[str, RunOutcome, float | None]]) -> str:
    """
    Return the table.

    :param rows: label, outcome, and the strain that the method allows: 0 where edges keep their
        length, None where it allows any
    """
    lines = [_HEAD, ('---',) * len(_HEAD)]
    lines.extend(_cells(*row) for row in rows)
    return '\n'.join(f'| {" | ".join(cells)} |' for cells in lines)


def end_of(outcome: RunOutcome) -> str:
    """Return how the run ended, in words."""
    if outcome.stopped:
        return f'not finite after {outcome.end:.3g} s'
    return f'{outcome.end:.3g} s, finite'


def _cells(label: str, outcome: RunOutcome, allowed: float | None) -> tuple[str, ...]:
    return (
        label, f'{outcome.dt:g}', f'{outcome.substeps:.1f}', _percent(outcome.max_strain),
        '-' if allowed is None else _percent(max(0.0, outcome.max_strain - allowed)),
        f'{outcome.kinetic_energy:.4g}', end_of(outcome), f'{outcome.wall_seconds:.2g}')


def _percent(strain: float) -> str:
    return f'{100.0 * strain:.3g} %'


# A recording in a few numbers, and those in words.

_TOO_LONG = 1.5  # over the usual time from frame to frame
_MOST_SHOWN = 4


def find_gaps(times: np.ndarray, resets: np.ndarray) -> list[tuple[float, float]]:
    """
    Return begin and end [s] of each span without frames where there should be some.

    :param times: of the frames [s], growing
    :param resets: made before each frame; nobody misses a frame across one
    """
    if len(times) < 3:
        return []
    steps = np.diff(times)
    same_run = np.diff(resets) == 0
    if not same_run.any():
        return []
    # Times are multiples of dt, so frames may come with one dt more or less.
    usual = max(np.median(steps[same_run]), np.percentile(steps[same_run], 90))
    found = np.flatnonzero(same_run & (steps > _TOO_LONG * usual))
    return [(float(times[place]), float(times[place + 1])) for place in found]


@dataclass(frozen=True)
class Summary:
    """
    What happened in a recording; nan where it does not say.

    :param device: GL_RENDERER; empty where the recording does not say
    :param modes: each once, in the order they came
    :param switches: of the mode: time [s], mode before and mode after
    :param begin: time of the first frame [s]
    :param end: time of the last frame [s]
    :param dt: [s]
    :param largest_strain: of all springs over all frames
    :param mean_strain: of all nodes over all frames
    :param largest_kinetic_energy: over all frames [J]
    :param first_energy: total energy of the first frame [J]
    :param last_energy: total energy of the last frame [J]
    :param finite: False when the run stopped because the next state was not finite
    :param real_time_factor: median of the frames that ran; 0 when none did
    :param step_wall_time: median wall time of one dt [s]
    :param most_active: edges at their limit, in the frame with most
    :param most_listed: edges near their limit that a substep solved for, in the frame with most
    :param limit_unreached: frames in which the rounds of such a substep did not suffice
    :param strain_over_bound: largest strain over the limit of its mode; 0 without such a limit
    :param solver_iterations: most of any frame; 0 without a solver
    :param solver_residual: worst of any frame
    :param solver_missed: frames in which a solve stopped before the residual requested
    :param lengths_lost: frames in which an edge was far off its length or limit
    :param contact_lost: frames in which contact of the surface was not held
    :param layer_overlap: of layers over their thickness, the largest
    :param settling: frames in which a limit closed in on a cloth that came with more strain
    :param settling_work: largest work of such a limit [J]
    :param stalled: frames in which a moving pin waited, as its edges pulled too hard
    :param gaps: begin and end [s] of spans without frames where there should be some
    :param missing: topics that would add figures
    :param is_whole: False when the recording was cut off, or a part of it can't be read
    :param problems: what could not be read, one sentence each
    """

    name: str
    node: str
    device: str
    rows: int
    cols: int
    modes: list[str]
    switches: list[tuple[float, str, str]]
    begin: float
    end: float
    frames: int
    dt: float
    substeps: float
    largest_strain: float
    last_strain: float
    mean_strain: float
    largest_kinetic_energy: float
    last_kinetic_energy: float
    first_energy: float
    last_energy: float
    finite: bool
    real_time_factor: float
    step_wall_time: float
    most_active: float
    most_listed: float
    limit_unreached: int
    strain_over_bound: float
    solver_iterations: float
    solver_residual: float
    solver_missed: int
    lengths_lost: int
    contact_lost: int
    layer_overlap: float
    settling: int
    settling_work: float
    stalled: int
    pushes: int
    pins: int
    releases: int
    resets: int
    grasps: dict[str, tuple[float, float]]
    gaps: list[tuple[float, float]]
    missing: list[str]
    is_whole: bool
    problems: list[str]

    @property
    def duration(self) -> float:
        """Get the simulated time from the first to the last frame [s]."""
        return self.end - self.begin

    @classmethod
    def of(cls, run: Run) -> 'Summary':
        """Return the summary of ``run``."""
        told = _Figures(run)
        columns = run.columns
        return cls(
            name=run.name, node=run.node, device=run.device, rows=run.rows, cols=run.cols,
            modes=run.modes.modes,
            switches=[(each.time, each.previous, each.mode) for each in run.modes.switches],
            begin=float(columns['time'][0]), end=float(columns['time'][-1]),
            frames=len(columns['time']), dt=told.last('dt'), substeps=told.last('substeps'),
            largest_strain=told.largest('max_strain'), last_strain=told.last('max_strain'),
            mean_strain=told.mean('mean_strain'),
            largest_kinetic_energy=told.largest('kinetic_energy'),
            last_kinetic_energy=told.last('kinetic_energy'),
            first_energy=told.first('total_energy'), last_energy=told.last('total_energy'),
            finite=told.all_finite and not run.stopped,
            real_time_factor=told.median_above_0('real_time_factor', 0.0),
            step_wall_time=told.median_above_0('step_wall_time', np.nan),
            most_active=told.largest('active_constraints'),
            most_listed=told.largest('listed_edges'),
            limit_unreached=int(np.count_nonzero(columns['limit_unreached'] > 0.0)),
            strain_over_bound=told.largest('strain_over_bound'),
            solver_iterations=told.largest('solver_iterations'),
            solver_residual=told.largest('solver_residual'),
            solver_missed=int(np.count_nonzero(columns['solver_reached'] == 0.0))
            if told.largest('solver_iterations') > 0 else 0,
            lengths_lost=int(np.count_nonzero(columns['lengths_are_held'] == 0.0)),
            contact_lost=int(np.count_nonzero(columns['surface_contact_held'] == 0.0)),
            layer_overlap=told.largest('layer_overlap'),
            settling=int(np.count_nonzero(columns['settling'] > 0.0)),
            settling_work=told.largest('settling_work'),
            stalled=int(np.count_nonzero(columns['stalled_pins'] > 0.0)),
            **{name: run.counts[name] for name in ('pushes', 'pins', 'releases', 'resets')},
            grasps=run.grasps, gaps=find_gaps(columns['time'], columns['resets']),
            missing=run.missing, is_whole=run.is_whole, problems=run.problems)


def summarise(recording: Recording) -> Summary:
    """Read ``recording`` once and return its summary; ClothSimError when it holds no frame."""
    return Summary.of(Run(recording))


class _Figures:
    """Reads the columns of a run, but for the rows whose energy is no longer finite."""

    def __init__(self, run: Run) -> None:
        self._columns = run.columns
        energy = run.columns['total_energy']
        # A row without stats has no energy, and no dt either.
        is_lost = ~np.isfinite(energy) & np.isfinite(run.columns['dt'])
        is_lost &= np.isfinite(energy).any()
        self.all_finite = not is_lost.any()
        self._good = ~is_lost

    def _values(self, name: str) -> np.ndarray:
        values = self._columns[name][self._good]
        return values[np.isfinite(values)]

    def _of(self, name: str, function: Any) -> float:
        values = self._values(name)
        return float(function(values)) if len(values) else np.nan

    def first(self, name: str) -> float:
        return self._of(name, lambda values: values[0])

    def last(self, name: str) -> float:
        return self._of(name, lambda values: values[-1])

    def largest(self, name: str) -> float:
        return self._of(name, np.max)

    def mean(self, name: str) -> float:
        return self._of(name, np.mean)

    def median_above_0(self, name: str, otherwise: float) -> float:
        values = self._values(name)
        return float(np.median(values[values > 0.0])) if (values > 0.0).any() else otherwise


def summary_lines(summary: Summary) -> dict[str, str]:
    """Return the lines of a recording by their names."""
    lines = {
        'cloth': f'{summary.rows} x {summary.cols} nodes' if summary.rows else 'not recorded',
        'mode': ', '.join(summary.modes) or 'not recorded',
        'device': summary.device or 'not recorded',
        'time': f'{summary.begin:.6g} to {summary.end:.6g} s, {summary.frames} frames',
        'dt': f'{figure(summary.dt, ".6g")} s in {figure(summary.substeps, ".6g")} substeps',
        'real-time factor': (
            f'{summary.real_time_factor:.3g}, median while running' if summary.real_time_factor
            else 'none recorded while running'),
        'step time': f'{figure(1e3 * summary.step_wall_time)} ms per time step, median',
        'inputs': f'pushes: {summary.pushes}, nodes released: {summary.releases}, '
                  f'pinned: {summary.pins}, resets: {summary.resets}',
        'max strain': f'{figure(summary.last_strain)} at the end, '
                      f'peak {figure(summary.largest_strain)}',
        'mean strain': f'{figure(summary.mean_strain)}, over all nodes and frames',
        'kinetic energy': f'{figure(summary.last_kinetic_energy)} J at the end, '
                          f'peak {figure(summary.largest_kinetic_energy)} J',
        'total energy': f'{figure(summary.first_energy, ".4g")} J at the start, '
                        f'{figure(summary.last_energy, ".4g")} J at the end',
    }
    if summary.solver_iterations > 0:
        lines['solver'] = (
            f'at most {summary.solver_iterations:.0f} iterations, worst residual '
            f'{summary.solver_residual:.3g}, {summary.solver_missed} frames above the tolerance')
    if summary.most_active > 0:
        lines['constraints'] = f'at most {summary.most_active:.0f} active'
    if summary.most_listed > 0:
        lines['listed edges'] = f'at most {summary.most_listed:.0f} in a substep'
    if summary.strain_over_bound > 0:
        lines['strain limit'] = f'at most {summary.strain_over_bound:.3g} times the limit'
    if summary.limit_unreached:
        lines['limit tolerance'] = f'not reached in {summary.limit_unreached} frames'
    if summary.lengths_lost:
        lines['lengths'] = f'far off in {summary.lengths_lost} frames'
    if summary.contact_lost:
        lines['surface contact'] = (
            f'not held in {summary.contact_lost} frames; layers overlap by up to '
            f'{100.0 * summary.layer_overlap:.2g} % of their thickness')
    if summary.settling:
        lines['settling'] = (
            f'in {summary.settling} frames, by a limit that did {summary.settling_work:.3g} J of '
            'work')
    if summary.stalled:
        lines['stalled pins'] = f'in {summary.stalled} frames'
    if summary.grasps:
        lines['grasps'] = _listed([
            f'{name} from {begin:.6g} to {end:.6g} s'
            for name, (begin, end) in sorted(summary.grasps.items())])
    if summary.switches:
        lines['mode switches'] = _listed([
            f'{mode} at {time:.6g} s' for time, _, mode in summary.switches])
    if summary.gaps:
        lines['gaps'] = _listed([f'{begin:.6g} to {end:.6g} s' for begin, end in summary.gaps])
    if summary.missing:
        lines['not recorded'] = ', '.join(summary.missing)
    lines['state'] = 'finite' if summary.finite else 'became non-finite'
    if summary.problems:
        lines['problems'] = '; '.join(summary.problems)
    return lines


def text_table(lines: dict[str, str]) -> str:
    """Return ``lines`` below each other."""
    return '\n'.join(f'{name:18} {value}' for name, value in lines.items())


def figure(value: float, form: str = '.3g') -> str:
    """Return a number, or that there is none."""
    return f'{value:{form}}' if math.isfinite(value) else 'unknown'


def _listed(parts: Sequence[str]) -> str:
    more = len(parts) - _MOST_SHOWN
    return ', '.join(parts[:_MOST_SHOWN]) + (f' and {more} more' if more > 0 else '')
