# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Errors of the GL device and of shaders."""


class DeviceError(RuntimeError):
    """No usable GL device, or a request beyond its limits; says what to change."""


class ShaderError(RuntimeError):
    """A shader does not compile or link; carries the offending lines."""


class MissingFilesError(RuntimeError):
    """Files that belong to the code are not where they are installed."""
