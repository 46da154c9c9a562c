# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Let the nodes of a test session find each other soon."""

from collections.abc import Iterator
from pathlib import Path

import pytest

PROFILE = Path(__file__).with_suffix('.xml')


def quick_discovery() -> Iterator[None]:
    """Set the profile that Fast DDS reads when a process joins the graph, while in use."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(PROFILE))
        yield
