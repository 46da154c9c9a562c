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

"""A run that is slower than it should be, in words."""


def slow_pace(achieved: float, wanted: float, *, substeps: int, automatic: bool) -> str:
    """
    Return that a run is too slow, and what makes it faster.

    :param achieved: simulated time per wall time
    :param wanted: the same as asked for
    :param substeps: in each dt
    :param automatic: True where they follow from what is stable: a longer dt has more of them
    """
    faster = 'softer springs' if automatic and substeps > 1 else 'a longer dt'
    return (
        f'{achieved:.3g} x real time, below the target {wanted:.3g}: use fewer nodes, {faster}, '
        'another mode or a lower real_time_factor')
