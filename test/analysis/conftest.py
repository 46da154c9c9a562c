# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording with a known content, and frames made by hand."""

from recording_fixtures import hanging  # noqa: F401
from recording_fixtures import known  # noqa: F401
