# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Reading a whole run, frame by frame."""

import tracemalloc

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.recording.recorder import Recorder
from copied_bag import copy_bag
from made_cloud import make_cloud
import numpy as np


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
