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

"""cloth_sim mode."""


def test_switches(verb):
    """A mode could not be chosen from the command line."""
    result = verb('mode', 'mass_spring')
    assert (result.returncode, result.stdout) == (0, 'mode mass_spring, was mass_spring\n')


def test_tells_why_not(verb):
    """A script would go on with another mode than it asked for."""
    result = verb('mode', 'fluid')
    assert (result.returncode, result.stdout) == (1, '')
    assert 'must be one of' in result.stderr
