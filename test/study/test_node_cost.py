# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a node costs is measured on a real one, part by part, with its clouds counted."""

import json
import os
import subprocess
import sys
import time

from cloth_sim_ros.sim.model.stability import safe_substep
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.node_cost import PARTS
from cloth_sim_ros.study.node_cost import processor_time
from cloth_sim_ros.study.node_cost import scene_values
import pytest


def bench(*arguments):
    """Call the bench in a process of its own."""
    return subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'bench', '--node', '--rounds', '1',
         '--seconds', '0.3', '--sizes', '8', *arguments], capture_output=True, text=True)


@pytest.mark.long
def test_each_part_has_its_cost_and_its_clouds():
    """The table in the docs could not be made again, or clouds be lost unseen."""
    done = bench('--json')
    assert done.returncode == 0, done.stderr
    cost = json.loads(done.stdout)
    assert (cost['rows'], cost['cols']) == (8, 8) and cost['device']
    assert [part['part'] for part in cost['parts']] == list(PARTS)
    for part in cost['parts']:
        [ratio], [processor] = part['over_bare'], part['processor']
        assert ratio == pytest.approx(processor / cost['bare'][0])
        assert part['sent'] >= part['lost'] >= 0
        assert (part['sent'] > 0) == (part['part'] != 'node')


def test_a_node_that_does_not_start_is_explained():
    """The user would wait for a minute and learn nothing."""
    done = bench('--set', 'publish.points=maybe')
    assert done.returncode == 1
    assert 'publish.points' in done.stderr and 'Traceback' not in done.stderr


def test_finer_cloths_take_fewer_substeps():
    """The node of 128 x 128 could not keep up, and nothing be said of a run at 50 Hz."""
    lengths = [safe_substep(Scene(scene_values(size, {}))) for size in (32, 64, 128)]
    assert lengths == sorted(lengths)


def test_processor_time_is_that_of_the_process():
    """Ratios would be of something else."""
    before, own = processor_time(os.getpid()), time.process_time()
    while time.process_time() - own < 0.2:
        pass
    # The clock of /proc ticks a hundred times a second.
    assert processor_time(os.getpid()) - before == pytest.approx(
        time.process_time() - own, abs=0.05)
