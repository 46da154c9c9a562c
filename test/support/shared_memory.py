# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The shared memory that a process has of Fast DDS."""

from pathlib import Path


def largest_segment(pid: int) -> int:
    """Return the size of the largest segment that a process has mapped [bytes]."""
    sizes = [0]
    for line in Path(f'/proc/{pid}/maps').read_text(encoding='ascii').splitlines():
        if '/dev/shm/fastrtps_' in line:
            begin, end = (int(address, 16) for address in line.split()[0].split('-'))
            sizes.append(end - begin)
    return max(sizes)


def segments_of(pid: int, *, exclusively: bool = False) -> set[Path]:
    """
    Return the segments that a process has mapped.

    :param exclusively: only its own, whose lock files it holds open
    """
    try:
        lines = Path(f'/proc/{pid}/maps').read_text(encoding='ascii').splitlines()
        opened = {str(link.readlink()) for link in Path(f'/proc/{pid}/fd').iterdir()}
    except OSError:
        return set()
    mapped = {line.split()[-1] for line in lines if '/dev/shm/fast' in line}
    return {
        Path(name) for name in mapped
        if '_port' not in name and (not exclusively or f'{name}_el' in opened)}


def shared_memory_files() -> int:
    """Return the number of files that processes, also dead ones, have in shared memory."""
    return sum(1 for _ in Path('/dev/shm').iterdir())
