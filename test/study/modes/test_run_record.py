# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Work and energy of a run are those of its snapshots."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.modes.run_record import RunRecord
from made_snapshot import make_snapshot
import pytest

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
    """What was gained and lost again would not be told, or not over M g L."""
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
