# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The bench of pictures."""

from cloth_sim_ros.study.camera_speed import measure_camera
from cloth_sim_ros.study.camera_speed import PICTURES
import pytest


def test_each_kind_of_picture_is_measured():
    """A kind would be missing, or its ratio be that of other rounds."""
    found = list(measure_camera(8, 2, (32, 24)))
    assert [each.taken for each in found] == list(PICTURES)
    assert found[0].ratios == pytest.approx([1.0, 1.0])
    assert all(len(each.picture) == len(each.ratios) == 2 for each in found)
    assert all(min(each.picture) > 0.0 and each.device for each in found[1:])
    assert '32 x 24 pixels beside 8 x 8 nodes' in found[1].in_words()
    assert found[1].as_dict()['taken'] == 'depth'
