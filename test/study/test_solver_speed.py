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

"""The comparison of solvers measures what it says, on every size asked for."""

from cloth_sim_ros.study.solver_speed import compare_solvers


def test_each_step_and_preconditioner_is_measured():
    """A figure would stand for another step, or for a solve that did not get there."""
    comparison, = compare_solvers([9], rounds=2, round_seconds=0.001)
    assert (comparison.rows, comparison.cols) == (9, 9)
    assert comparison.device
    assert len(comparison.speeds) == 8
    assert len({(speed.step, speed.preconditioner) for speed in comparison.speeds}) == 8
    for speed in comparison.speeds:
        assert len(speed.rounds) == 2
        assert speed.iterations > 0
        assert speed.residual <= 1e-2
        assert speed.median > 0.0
    assert comparison.as_dict()['speeds'][0]['step'] == 'springs, dt 0.01 s'
