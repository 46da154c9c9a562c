# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes in which edges are springs in all modes."""

from typing import Any

# The springs that parameters have by default, light and soft, without air.
PLAIN: dict[str, Any] = {'material.preset': 'none', 'adaptive.threshold': 0.5}
# Edges that are those of the fabric in mode constraint, and below the limit in mode adaptive.
AS_SPRINGS: dict[str, dict[str, Any]] = {
    'mass_spring': {}, 'adaptive': {'adaptive.threshold': 0.5},
    'constraint': {'constraint.hard': [], 'constraint.springs': ['structural', 'shear']}}
