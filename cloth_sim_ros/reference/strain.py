# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far springs are from their rest length; bend springs do not count."""

from collections.abc import Sequence

from cloth_sim_ros.reference.springs import SpringSet
import numpy as np


def node_strain(springs: Sequence[SpringSet], positions: np.ndarray) -> np.ndarray:
    """Return the largest |l / L0 - 1| of the structural and shear springs at each node."""
    strain = np.zeros(positions.shape[:2])
    for spring_set in springs:
        if spring_set.family == 'bend':
            continue
        magnitude = np.abs(spring_set.strains(positions))
        for end in spring_set.ends(strain):
            np.maximum(end, magnitude, out=end)
    return strain
