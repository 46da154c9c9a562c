# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The processes of a session, to find any that were left behind."""

from contextlib import suppress
import os
from pathlib import Path
import signal


def processes_of(session: int) -> list[int]:
    """Return the processes of a session that still run."""
    found = []
    for stat in Path('/proc').glob('[0-9]*/stat'):
        try:
            state, _, _, its_session = stat.read_text().rpartition(')')[2].split()[:4]
        except OSError:
            continue  # it has ended meanwhile
        if int(its_session) == session and state != 'Z':
            found.append(int(stat.parent.name))
    return found


def kill_all_of(session: int) -> None:
    """Kill the processes of a session; one that ends by the end of another is no matter."""
    for pid in processes_of(session):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
