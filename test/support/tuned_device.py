# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A device with a tuning, in a cache directory of the test."""

from collections.abc import Mapping
from pathlib import Path

from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.device.tuning import Tuning
from cloth_sim_ros.sim.device.tuning import VARIABLE
from cloth_sim_ros.sim.device.tuning import write_tuning
import pytest


def allow_tunings(patch: pytest.MonkeyPatch, folder: Path) -> None:
    """Have tunings be used, and kept in ``folder``, until ``patch`` is undone."""
    patch.delenv(VARIABLE, raising=False)
    patch.setenv('XDG_CACHE_HOME', str(folder))


def tune_device(
        patch: pytest.MonkeyPatch, folder: Path, device: str, driver: str,
        choices: Mapping[int, Choice]) -> Path:
    """Have the device use ``choices``, by nodes along each side; return the file they are in."""
    allow_tunings(patch, folder)
    return write_tuning(Tuning(device, driver, choices))
