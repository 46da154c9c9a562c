# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The end of a recording that was under way."""

from cloth_sim_ros.sim.errors import ClothSimError


class RecordingError(ClothSimError):
    """A recording that could not continue; what was flushed before stays readable."""


class RecordingFull(RecordingError):
    """A recording that was completed before it was stopped, as it may not become larger."""
