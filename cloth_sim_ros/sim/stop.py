# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a step that takes long is abandoned: by a shutdown, or by who only wants to time it."""

from collections.abc import Callable

# Asked between the substeps, solves and iterations of a step; True abandons the step. It is asked
# on the thread that steps, often, and may read what another thread has set.
Stop = Callable[[], bool]


class StepAbandoned(Exception):
    """The step was abandoned, as a Stop has asked; the state goes back to the last one checked."""


def never() -> bool:
    """Return False: steps are made whole."""
    return False


def leave_if(stop: Stop) -> None:
    """Raise StepAbandoned where ``stop`` asks for it."""
    if stop():
        raise StepAbandoned
