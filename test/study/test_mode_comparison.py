# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Modes are compared on the same cloth, in turn, by what each came to."""

import json
import math

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.mode_comparison import compare_modes
from cloth_sim_ros.study.mode_comparison import comparison_table
from cloth_sim_ros.study.mode_comparison import growth_exponents
from cloth_sim_ros.study.mode_comparison import ModeSpeed
from cloth_sim_ros.study.mode_runs import Contender
from cloth_sim_ros.study.mode_runs import CONTENDERS
from cloth_sim_ros.study.mode_runs import edge_stretch
from cloth_sim_ros.study.mode_runs import stretch_of
import numpy as np
import pytest

SECONDS = 0.1


@pytest.fixture(scope='module')
def comparison():
    """Return a short comparison on two tiny grids."""
    return compare_modes(list(CONTENDERS.values()), [6, 10], seconds=SECONDS, rounds=2)


@pytest.fixture(scope='module')
def plain_runs():
    """Return the snapshots of each contender at its steps of dt, simulated alone, by name."""
    context = Context(single_thread=True)
    found = {}
    for contender in CONTENDERS.values():
        run = Simulation(contender.scene(6), context=context)
        found[contender.name] = [run.snapshot()]
        for _ in range(round(SECONDS / run.dt)):
            run.step()
            found[contender.name].append(run.snapshot())
        run.close()
    context.close()
    return found


def speed_of(comparison, name, grid):
    """Return the figures of one contender on one grid."""
    return next(speed for speed in comparison.speeds
                if (speed.contender, speed.grid) == (name, grid))


def made_speed(name, grid, factor, **others):
    """Return figures that were not measured."""
    return ModeSpeed(contender=name, grid=grid, values={}, real_time_factor=factor,
                     bound='', is_within_bound=True, **others)


def test_every_contender_is_measured_on_every_grid(comparison):
    """A mode would be left out, or compared with a round of its own."""
    assert [(speed.grid, speed.contender) for speed in comparison.speeds] == [
        (grid, name) for grid in (6, 10) for name in CONTENDERS]
    assert set(comparison.growth) == set(CONTENDERS)
    for speed in comparison.speeds:
        own, baseline = speed, speed_of(comparison, 'mass_spring', speed.grid)
        assert speed.ratios == pytest.approx([
            factor / other for factor, other in zip(
                own.real_time_factors, baseline.real_time_factors)])
        assert len(speed.ratios) == 2 and min(speed.real_time_factors) > 0.0
    assert speed_of(comparison, 'mass_spring', 10).ratio == 1.0


@pytest.mark.parametrize('name', CONTENDERS)
def test_figures_are_those_of_the_run_alone(comparison, plain_runs, name):
    """What has its turn in between, or is timed, would change what is simulated."""
    start, *steps = plain_runs[name]
    speed = speed_of(comparison, name, 6)
    scene = CONTENDERS[name].scene(6)
    in_a_frame = round(0.02 / scene['dt'])
    frames = steps[in_a_frame - 1::in_a_frame]
    assert frames[0].time == pytest.approx(0.02) and len(frames) == 5
    assert speed.stretch == stretch_of(
        [edge_stretch(scene, frame.positions) for frame in frames])
    assert speed.substep_rate == pytest.approx(sum(step.substeps for step in steps) / SECONDS)
    assert speed.solve_rate == pytest.approx(
        2 * speed.substep_rate if name == 'constraint' else 0.0)
    assert speed.energy_rise == pytest.approx(
        max(0.0, *(frame.total_energy - start.total_energy for frame in frames))
        / (0.15 * 9.81))


def test_the_strain_of_the_shader_is_the_same(plain_runs):
    """The peak would be that of other edges than those the project reports the strain of."""
    scene = CONTENDERS['mass_spring'].scene(6)
    for step in plain_runs['mass_spring'][1:]:
        peak = edge_stretch(scene, step.positions).max()
        # The shader counts edges that are shorter, too.
        assert peak <= step.max_strain + 1e-6
    assert peak == pytest.approx(step.max_strain, abs=1e-6)


def test_growth_is_the_exponent_of_wall_time():
    """The cost of a mode would be reported with another growth with the grid."""
    speeds = [made_speed('cubic', grid, 1.0 / grid**3) for grid in (32, 64, 128)]
    speeds += [made_speed('bent', grid, factor)
               for grid, factor in ((32, 1.0), (64, 0.25), (128, 0.015625))]
    speeds += [made_speed('alone', 32, 1.0), made_speed('lost', 32, 1.0),
               made_speed('lost', 64, None, failure='lost')]
    # From one grid to the next the cost is 4 and 16 times: the line between has the power 3.
    found = growth_exponents(speeds)
    assert {name: growth.exponent for name, growth in found.items()} == pytest.approx(
        {'cubic': 3.0, 'bent': 3.0})
    # Its middle is off the line by 2 / 3 of a power of 2, the ends by 1 / 3 each.
    assert found['cubic'].error == pytest.approx(0.0, abs=1e-9)
    assert found['bent'].error == pytest.approx(math.sqrt(1.0 / 3.0))


def test_a_lost_state_does_not_end_the_others():
    """A setting that blows up would take hours of the others' figures with it."""
    wild = Contender('wild', {
        'mode': 'constraint', 'areal_density': 1e-6, 'pushes.start': [0.01] * 100,
        'pushes.duration': [1.0] * 100, 'pushes.force': [0.0, 0.0, 1e9] * 100})
    comparison = compare_modes(
        [wild, CONTENDERS['mass_spring']], [6], seconds=0.1, rounds=2)
    lost, finished = comparison.speeds
    assert lost.failure and lost.real_time_factor is None and not lost.is_within_bound
    assert finished.failure is None and len(finished.real_time_factors) == 2
    assert lost.failure in comparison_table(comparison)
    assert json.loads(json.dumps(comparison.as_dict(), allow_nan=False))


def test_the_table_has_a_row_for_each(comparison):
    """A reader would not learn whether a speed is of a cloth that keeps its length."""
    lines = comparison_table(comparison).splitlines()
    assert comparison.device in lines[0]
    head, _, *rows = [line for line in lines if line.startswith('|')]
    assert {line.count('|') for line in (head, *rows)} == {head.count('|')}
    for row, speed in zip(rows, comparison.speeds, strict=True):
        verdict = 'yes' if speed.is_within_bound else 'NO'
        assert f'| {verdict} ({speed.bound}) |' in row
    assert lines[-1].startswith('Wall time grows with N')


@pytest.mark.parametrize(('change', 'reason'), [
    ({'grids': [6, 1]}, 'at least 2'), ({'seconds': 0.01}, '0.01 s: give 0.02 to 3600'),
    ({'seconds': np.nan}, 'nan s'), ({'seconds': np.inf}, 'inf s'), ({'rounds': 0}, '0 rounds')])
def test_what_makes_no_run_is_refused(change, reason):
    """A comparison would end in a traceback, or never."""
    asked = {'grids': [6], 'seconds': 0.1, 'rounds': 1, **change}
    with pytest.raises(ClothSimError, match=reason):
        compare_modes(list(CONTENDERS.values()), **asked)


def test_a_dt_that_is_no_part_of_a_frame_is_refused():
    """Figures would be of frames at other times than those of the others."""
    odd = Contender('odd', {'mode': 'constraint', 'dt': 0.003})
    with pytest.raises(ClothSimError, match='dt of odd is 0.003 s'):
        compare_modes([odd], [6], seconds=0.1, rounds=1)
