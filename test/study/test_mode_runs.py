# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs in which modes are compared: which settings compete, how they stretch and cost."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.mode_runs import edge_stretch
from cloth_sim_ros.study.mode_runs import RunRecord
from cloth_sim_ros.study.mode_runs import Stretch
from cloth_sim_ros.study.mode_runs import stretch_of
from cloth_sim_ros.study.mode_runs import StretchBound
from made_snapshot import make_snapshot
import numpy as np
import pytest

SQUARE = Scene({'rows': 2, 'cols': 2, 'width': 1.0, 'height': 1.0})
# Strain of a diagonal of the unit square when it has become 1.1 x 1 m [1].
DIAGONAL = np.hypot(1.1, 1.0) / np.sqrt(2.0) - 1.0


def scaled(scene, *factors):
    """Return the positions at rest with each axis times its factor."""
    return scene.rest_positions() * np.array(factors)


def test_each_edge_is_there_once():
    """An edge would be left out, or weigh twice in a percentile."""
    assert np.sort(edge_stretch(SQUARE, scaled(SQUARE, 1.1, 1.0, 1.0))) == pytest.approx(
        [0.0, 0.0, DIAGONAL, DIAGONAL, 0.1, 0.1], abs=1e-7)


def test_bend_springs_do_not_count():
    """What only stands for bending would be taken for stretch."""
    scene = Scene({'rows': 1, 'cols': 3, 'width': 2.0})
    assert scene.models('bend')
    assert edge_stretch(scene, scaled(scene, 1.2, 1.0, 1.0)) == pytest.approx(
        [0.2, 0.2], abs=1e-7)


def test_edges_that_are_no_springs_count():
    """A mode without springs would seem to hold all lengths."""
    scene = Scene({
        'rows': 2, 'cols': 2, 'mode': 'constraint', 'stiffness.structural': 0.0,
        'stiffness.shear': 0.0, 'damping.structural': 0.0, 'damping.shear': 0.0})
    assert len(edge_stretch(scene, scene.rest_positions())) == 6


def test_a_fold_is_no_stretch():
    """A cloth that is crumpled would seem to stretch, or hide that another edge does."""
    assert edge_stretch(SQUARE, scaled(SQUARE, 0.5, 1.0, 1.0)) == pytest.approx(
        np.zeros(6), abs=1e-7)


def test_peak_and_percentiles_of_a_run():
    """The figures would not be those that their definition gives by hand."""
    # The 95th percentile of 21 edges is that at index 19. That of all 42 lies 0.95 of the way from
    # index 38, which is 0.034, to the next, 0.036.
    first = np.arange(21) / 1000.0
    stretch = stretch_of([first, 2.0 * first[::-1]])
    assert stretch.peak == pytest.approx(0.040)
    assert stretch.worst_frame_percentile == pytest.approx(0.038)
    assert stretch.percentile == pytest.approx(0.0359)


def test_the_worst_frame_need_not_be_that_of_the_peak():
    """One edge that whips round would choose the frame in which all are measured."""
    whip = np.zeros(21)
    whip[0] = 0.5
    pulled = np.full(21, 0.02)
    stretch = stretch_of([whip, pulled])
    assert (stretch.peak, stretch.worst_frame_percentile) == (0.5, 0.02)


@pytest.mark.parametrize(('peak', 'percentile', 'is_within'), [
    (0.02, 0.012, True), (0.0201, 0.012, False), (0.02, 0.0121, False)])
def test_both_bounds_have_to_hold(peak, percentile, is_within):
    """A cloth that is stretched all over would be compared with one that is not."""
    stretch = Stretch(peak=peak, worst_frame_percentile=percentile, percentile=0.0)
    assert stretch.is_within(StretchBound(peak=0.02, percentile=0.012)) is is_within


# Work and energy of a run are those of its snapshots.

# 0.2 kg, 9.81 m/s2 and 0.5 m: M g L is 0.981 J.
SCENE = Scene({'rows': 3, 'cols': 4, 'width': 2.0, 'height': 0.5, 'areal_density': 0.2})


def energies(kinetic, elastic, gravitational):
    """Return a snapshot with these energies [J]."""
    return make_snapshot(
        3, 4, kinetic_energy=kinetic, elastic_energy=elastic,
        gravitational_energy=gravitational)


def test_work_is_that_of_all_steps():
    """A rate would be that of the last step, or of a step that a few solves made seem cheap."""
    record = RunRecord(SCENE, make_snapshot(3, 4))
    for substeps, solves, mean in ((3, 6, 10.0), (1, 2, 4.0)):
        record.add_step(make_snapshot(
            3, 4, dt=0.005, substeps=substeps, solves=solves, mean_iterations=mean))
    assert record.substep_rate == pytest.approx(400.0)
    assert record.solve_rate == pytest.approx(800.0)
    assert record.iterations_per_solve == pytest.approx(68.0 / 8.0)


def test_without_a_solver_there_are_no_iterations():
    """A mode without a solver would seem to have one that needs none."""
    record = RunRecord(SCENE, make_snapshot(3, 4))
    record.add_step(make_snapshot(3, 4, dt=0.005, substeps=3))
    assert (record.solve_rate, record.iterations_per_solve) == (0.0, None)


def test_the_largest_rise_of_energy_counts():
    """Energy gained and lost again would not be reported, or not over M g L."""
    record = RunRecord(SCENE, energies(0.0, 0.0, 1.0))
    for snapshot in (energies(0.3, 0.1, 0.5), energies(0.5, 0.2, 0.4981),
                     energies(0.1, 0.1, 0.4)):
        record.add_frame(snapshot)
    assert record.energy_rise == pytest.approx(0.1981 / 0.981)


def test_energy_that_only_falls_is_no_rise():
    """Damping would be taken for a negative rise."""
    record = RunRecord(SCENE, energies(0.0, 0.0, 1.0))
    record.add_frame(energies(0.3, 0.1, 0.5))
    assert record.energy_rise == 0.0
