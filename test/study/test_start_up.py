# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The time to the first cloud is measured on a real node, and a node that fails is explained."""

import json
from pathlib import Path
import subprocess
import sys

import pytest


def bench_start_up(scene: Path) -> subprocess.CompletedProcess:
    """Call the bench in a process of its own."""
    return subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'bench', '--start-up', str(scene),
         '--rounds', '2', '--json', '--set', 'cols=6'], capture_output=True, text=True)


@pytest.mark.long
def test_each_round_has_its_time(tmp_path: Path):
    """The figure in the docs could not be made again."""
    scene = tmp_path / 'scene.yaml'
    scene.write_text('/**:\n  ros__parameters:\n    rows: 8\n    cols: 8\n')
    done = bench_start_up(scene)
    assert done.returncode == 0, done.stderr
    times = json.loads(done.stdout)['seconds_to_first_cloud']
    assert len(times) == 2
    assert all(time > 0.0 for time in times)


def test_a_node_that_does_not_start_is_explained(tmp_path: Path):
    """The user would wait a minute without a message."""
    scene = tmp_path / 'scene.yaml'
    scene.write_text('/**:\n  ros__parameters:\n    rows: 0\n')
    done = bench_start_up(scene)
    assert done.returncode == 1
    assert 'rows 0 is outside its range' in done.stderr
