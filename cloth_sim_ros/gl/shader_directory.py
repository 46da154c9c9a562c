# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the shaders lie: in the source tree, or in the share folder of an installed package."""

from pathlib import Path

from cloth_sim_ros.gl.shared_directory import shared_directory


def shader_directory() -> Path:
    """Return the folder of the shaders that belong to this code."""
    return shared_directory('shaders')
