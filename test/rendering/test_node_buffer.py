# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The nodes on the device are those of the cloth, or a reason why they are not there."""

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
import numpy as np
import pytest


def test_a_cloth_too_large_for_the_device_is_refused(flat):
    """A part of it would be missing from the picture, silently."""
    with pytest.raises(DeviceError, match='9 x 9 nodes is too large.*at most 80 nodes'):
        NodeBuffer(161).load(flat(), np.zeros(3))
    with pytest.raises(DeviceError, match='9 x 9 nodes is too large'):
        NodeBuffer(161).load_points(flat().positions, np.zeros(3))
