# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The frame of a message from outside."""

from cloth_sim_ros.node.frame_check import check_frame
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


@pytest.mark.parametrize('frame', ['', 'world'])
def test_takes_its_own_frame(frame: str):
    """Points of the cloth's own frame would be refused."""
    check_frame(frame, 'world')


def test_refuses_another():
    """A point would be taken for another one, far away."""
    with pytest.raises(
            ClothSimError, match="is 'tool0' but the frame of the cloth is 'world': transform"):
        check_frame('tool0', 'world')
