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

"""cloth_sim record."""

from pathlib import Path

from recorded import Recorded


def test_records(verb, verb_node):
    """A recording could not be made from the command line, or its path would not be told."""
    started = verb('record', 'start', 'by_hand')
    assert started.returncode == 0, started.stderr
    path = Path(started.stdout.strip())
    assert path == verb_node.folder / 'bags' / 'by_hand'
    again = verb('record', 'start')
    assert again.returncode == 1
    assert '`cloth_sim record stop`' in again.stderr
    stopped = verb('record', 'stop')
    assert (stopped.returncode, stopped.stdout) == (0, f'closed {path}\n')
    assert Recorded(path).messages('points')
    assert verb('record', 'stop').returncode == 1
