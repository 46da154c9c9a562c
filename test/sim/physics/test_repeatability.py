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

"""The same scene on the same device gives the same bits."""

import json
import os
import subprocess
import sys

import pytest

SCENE = {
    'rows': 37, 'cols': 23, 'dt': 0.004, 'start.jitter': 0.05, 'pushes.start': [0.1, 0.2],
    'pushes.duration': [0.1, 0.05], 'pushes.force': [0.0, 0.0, 4.0, 1.0, 0.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.4]}

IN_A_PROCESS = """
import json, sys
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
simulation = Simulation(Scene(json.loads(sys.argv[1])))
simulation.advance(0.5)
print(simulation.snapshot().state_sha256)
"""


def _hash_of_a_process(values, **environment):
    done = subprocess.run(
        [sys.executable, '-c', IN_A_PROCESS, json.dumps(values)], check=True, text=True,
        capture_output=True, env={**os.environ, **environment})
    return done.stdout.strip()


@pytest.mark.parametrize('loads_and_block', [('auto', 0), ('texture', 1), ('storage', 2)])
def test_two_processes_give_one_state(any_mode, loads_and_block):
    """A run depends on thread timing or on memory nobody wrote."""
    loads, block = loads_and_block
    values = {**SCENE, 'mode': any_mode, 'loads': loads, 'block': block}
    assert _hash_of_a_process(values) == _hash_of_a_process(values)


def test_paper_layout_too(any_mode):
    """The paper's layout depends on thread timing or on memory nobody wrote."""
    values = {**SCENE, 'mode': any_mode, 'layout': 'paper'}
    assert _hash_of_a_process(values) == _hash_of_a_process(values)


def test_threads_do_not_show(any_mode):
    """The number of the driver's threads changes the result."""
    values = {**SCENE, 'mode': any_mode}
    assert _hash_of_a_process(values, LP_NUM_THREADS='0') == _hash_of_a_process(
        values, LP_NUM_THREADS='2')


def test_reset_starts_the_same_run(simulate, any_mode, layout):
    """Something of the run before a reset is left over."""
    simulation = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    start = simulation.snapshot().state_sha256
    simulation.advance(0.5)
    first = simulation.snapshot().state_sha256
    simulation.push((0.0, 1.0, 0.0), duration=5.0)
    simulation.pin(5, 5)
    simulation.advance(0.1)
    simulation.reset()
    assert simulation.snapshot().state_sha256 == start
    simulation.advance(0.5)
    assert simulation.snapshot().state_sha256 == first
    assert first != start


def test_pieces_make_the_same_run(simulate, any_mode, layout):
    """Looking at the state, or advancing in pieces, changes it."""
    whole = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    whole.advance(0.5)
    pieces = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    for _ in range(8):
        pieces.advance(0.0625)
        pieces.snapshot()
    assert pieces.steps == whole.steps == 125
    assert pieces.snapshot().state_sha256 == whole.snapshot().state_sha256
