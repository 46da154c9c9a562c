# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""An edge is found wherever it is, and said not to be there where it is not."""

from cloth_sim_ros.study.stability_runs import bisect_edge
import numpy as np
import pytest


@pytest.mark.parametrize('edge', [0.02, 0.7, 1.0, 1.3, 17.0])
def test_an_edge_is_found_near_a_guess(edge):
    """A measured edge would be off."""
    found = bisect_edge(lambda step: step < edge, 1.0)
    assert found.stable < edge <= found.unstable
    assert found.middle == pytest.approx(edge, rel=0.005)


def test_all_stable():
    """An edge would be made up where there is none."""
    found = bisect_edge(lambda step: True, 1.0, longest=3.0)
    assert found.stable == 3.0
    assert found.middle == found.unstable == np.inf


def test_none_stable():
    """An edge would be made up where there is none."""
    found = bisect_edge(lambda step: False, 1.0)
    assert found.stable == found.middle == 0.0
