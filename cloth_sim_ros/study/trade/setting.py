# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One way to step a scene."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_SHORT = {
    'refine': 'refine {}', 'dt': 'dt {:g} s', 'solver.tolerance': 'tolerance {:g}',
    'constraint.newton_iterations': 'solves {}'}


@dataclass(frozen=True)
class Setting:
    """
    Scene parameters that say how to step, and what they are a way to step.

    :param method: its name in the grid
    :param model: what finer and finer settings of the method converge to: springs, hard edges or
        springs with a limit
    :param fixed: parameters that all settings of the method have
    :param chosen: parameters that tell this setting from the others
    """

    method: str
    model: str
    fixed: Mapping[str, Any]
    chosen: Mapping[str, Any]

    @property
    def values(self) -> dict[str, Any]:
        """Return all parameters it sets."""
        return {**self.fixed, **self.chosen}

    @property
    def label(self) -> str:
        """Return what tells it from the others, in a few words."""
        return ', '.join(
            _SHORT[name].format(value) if name in _SHORT else f'{name} {value}'
            for name, value in self.chosen.items())
