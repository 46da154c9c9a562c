# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Say what a command is busy with while it compiles shaders."""

from collections.abc import Iterator
from contextlib import contextmanager
import sys
import threading

# What takes less is not worth a word [s].
_LONG = 0.5


@contextmanager
def compile_notice(mode: str) -> Iterator[None]:
    """Say on stderr that the shaders of ``mode`` are being compiled, if the block takes long."""
    def say() -> None:
        print(f'compiling shaders for mode {mode} ...', file=sys.stderr, flush=True)

    timer = threading.Timer(_LONG, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
