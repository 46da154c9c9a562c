# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The error of what is refused, in a file or anywhere else."""


class ClothSimError(ValueError):
    """A request that cannot be carried out; it has changed nothing."""
