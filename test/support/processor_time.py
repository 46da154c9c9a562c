# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a process has had of the processor, its memory, descriptors and threads."""

import os
from pathlib import Path
import re


def processor_time(pid: int) -> float:
    """
    Return the time that the main thread of a process has run so far [s].

    Of a node, that is the ROS thread; the others step, compile a mode or write a recording.
    """
    return int(_schedule(Path(f'/proc/{pid}/task/{pid}'))[0]) * 1e-9


def waited_for_a_processor() -> float:
    """Return how long the calling thread was ready to run, and did not, so far [s]."""
    return int(_schedule(Path('/proc/thread-self'))[1]) * 1e-9


def _schedule(task: Path) -> list[str]:
    # How long it ran and waited to run [ns], and how often.
    return (task / 'schedstat').read_text(encoding='ascii').split()


def memory(pid: int) -> int:
    """Return what a process has in memory that it shares with no file [bytes]."""
    status = Path(f'/proc/{pid}/status').read_text(encoding='ascii', errors='replace')
    return int(re.search(r'RssAnon:\s+(\d+) kB', status)[1]) * 1024


def descriptors(pid: int) -> int:
    """Return how many descriptors a process has open."""
    return len(os.listdir(f'/proc/{pid}/fd'))


def threads(pid: int) -> int:
    """Return how many threads a process has."""
    return len(os.listdir(f'/proc/{pid}/task'))
