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

"""The command `cloth_sim`, run as a user runs it."""

import subprocess
import sys

_START = 'import sys; from cloth_sim_ros.verb.main import main; sys.exit(main())'
PATIENCE = 60.0


def cloth_sim(
        *arguments: str, before: str = '',
        **options: object) -> subprocess.CompletedProcess[str]:
    """
    Return exit code and output of `cloth_sim ARGUMENTS`.

    :param before: Python to run first in the command's process
    :param options: for subprocess.run
    """
    return subprocess.run(
        [sys.executable, '-c', f'{before}\n{_START}', *arguments], capture_output=True,
        text=True, timeout=PATIENCE, **options)
