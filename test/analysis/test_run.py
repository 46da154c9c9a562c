# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The data of a recorded run, read in one pass."""

import tracemalloc
from types import SimpleNamespace

from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import LARGEST
from cloth_sim_ros.analysis.run import MOST_PINS
from cloth_sim_ros.analysis.run import PinColumns
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.run import SUM
from cloth_sim_ros.recording.recorder import Recorder
from copied_bag import copy_bag
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Wrench
from geometry_msgs.msg import WrenchStamped
from made_cloud import make_cloud
import numpy as np
from std_msgs.msg import Header


def columns_of(times, *forces):
    """Return the columns of forces, each given as time, frame and vector."""
    pins = PinColumns()
    for time, frame, (x, y, z) in forces:
        pins.read(Entry('pins/wrenches', time, WrenchStamped(
            header=Header(frame_id=frame), wrench=Wrench(force=Vector3(x=x, y=y, z=z)))))
    moments = SimpleNamespace(time=np.array(times), resets=np.zeros(len(times)))
    return pins.columns(vars(moments))


def test_pins_are_summed_and_told_apart():
    """The force of one pin would stand in the column of another, or be lost in the sum."""
    columns = columns_of(
        [0.0, 0.5, 1.0], (0.0, 'cloth_sim_pin_0_0', (3.0, 0.0, 4.0)),
        (0.0, 'cloth_sim_pin_0_12', (-1.0, 2.0, 0.0)),
        (1.0, 'cloth_sim_pin_0_12', (0.0, 0.0, 2.0)))
    np.testing.assert_array_equal(
        np.stack([columns[name] for name in SUM], axis=1),
        [(2.0, 2.0, 4.0), (np.nan,) * 3, (0.0, 0.0, 2.0)])
    np.testing.assert_array_equal(columns[LARGEST], [5.0, np.nan, 2.0])
    np.testing.assert_array_equal(columns['pin_0_0_force_z'], [4.0, np.nan, np.nan])
    np.testing.assert_array_equal(columns['pin_0_12_force_z'], [0.0, np.nan, 2.0])


def test_many_pins_have_no_columns_of_their_own():
    """An edge of 100 pins would make a table of 300 columns."""
    forces = [
        (0.0, f'cloth_sim_pin_0_{col}', (0.0, 0.0, 1.0)) for col in range(MOST_PINS + 1)]
    columns = columns_of([0.0], *forces)
    assert set(columns) == {*SUM, LARGEST}
    assert columns[SUM[2]].tolist() == [MOST_PINS + 1]


def test_frames_of_others_are_passed_over():
    """A wrench of a robot's wrist on our topic would count as a pin."""
    columns = columns_of([0.0], (0.0, 'wrist', (1.0, 0.0, 0.0)))
    assert np.isnan(columns[LARGEST]).all()


# Reading a whole run, frame by frame.


def test_every_frame_has_its_row(known):
    """Figures of one frame would stand beside the time of another."""
    run = Run(Recording(known.folder))
    np.testing.assert_allclose(
        run.columns['time'], [*(np.arange(20) / 50), *(0.38 + np.arange(6) / 50)])
    np.testing.assert_array_equal(run.columns['resets'], [0] * 20 + [1] * 6)
    np.testing.assert_array_equal(run.columns['kinetic_energy'], [*range(20), *range(6)])
    strains = [records['strain'].mean(dtype=float) for records in known.records]
    np.testing.assert_allclose(run.columns['mean_strain'], strains)
    heights = [records['z'].mean(dtype=float) for records in known.records]
    np.testing.assert_allclose(run.columns['mean_height'], heights, atol=1e-12)
    assert (run.counts['pushes'], run.counts['releases'], run.counts['resets']) == (2, 1, 1)
    assert [push.end for push in run.pushes] == [0.2, 0.38]


def test_late_clouds_stand_in_their_own_row(known, tmp_path):
    """A bag of `ros2 bag record`, where large messages come late, would look like resets."""
    bag = copy_bag(known.folder, tmp_path / 'late', delays={'/cloth_sim/points': 70_000_000})
    own, late = Run(Recording(known.folder)), Run(Recording(bag))
    for name in own.columns:
        np.testing.assert_array_equal(own.columns[name], late.columns[name])


def test_a_progress_bar_sees_all_that_is_read(known):
    """The bar would end too early, or never."""
    seen = []

    def watch(entries, count):
        for entry in entries:
            seen.append(count)
            yield entry

    Run(Recording(known.folder), watch)
    # All but the topology, the parameters and the like.
    assert len(seen) == seen[0] == 26 + 26 + 1 + 1 + 2 + 1 + 1


def test_a_long_run_needs_no_more_memory_than_a_short_one(tmp_path):
    """A long recording of a large cloth could not be read on a small machine."""
    recorder = Recorder(tmp_path, 'long')
    clouds = [make_cloud(64, 64, number)[0] for number in range(4)]
    for number in range(300):
        recorder.write('points', clouds[number % 4], number / 50)
    recorder.close()
    tracemalloc.start()
    try:
        Run(Recording(tmp_path / 'long'))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # Chunks of 1 MiB, of 54 MB in all.
    assert peak < 12e6
