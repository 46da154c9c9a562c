# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a verb says beside its result."""

from collections.abc import Callable
import sys


def sayer(verb: str) -> Callable[[str], None]:
    """Return what prints a sentence of ``verb`` to stderr."""
    return lambda sentence: print(f'cloth_sim {verb}: {sentence}', file=sys.stderr)
