# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""No mode is left out."""


def test_every_mode_is_tested(simulate, tested_modes):
    """A mode was added without its ground truths: give it a place in conftest.py."""
    assert tested_modes == set(simulate({'rows': 2, 'cols': 2}).available_modes)
