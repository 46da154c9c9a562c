# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The command `cloth_sim`, run as a user runs it."""

import subprocess
import sys

_START = 'import sys; from cloth_sim_ros.verb.main import main; sys.exit(main())'
PATIENCE = 300.0


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
