# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The time to the first cloud is measured on a real node, and a node that fails is explained."""

import json
from pathlib import Path
import subprocess
import sys


def bench_start_up(scene: Path) -> subprocess.CompletedProcess:
    """Call the bench in a process of its own."""
    return subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'bench', '--start-up', str(scene),
         '--rounds', '2', '--json', '--set', 'cols=6'], capture_output=True, text=True)


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
    """The user would wait a minute and be told nothing."""
    scene = tmp_path / 'scene.yaml'
    scene.write_text('/**:\n  ros__parameters:\n    rows: 0\n')
    done = bench_start_up(scene)
    assert done.returncode == 1
    assert 'rows 0 is outside its range' in done.stderr
