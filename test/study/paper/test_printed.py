# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the paper prints is complete and agrees with itself."""

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.paper.cloths import LIMITS
from cloth_sim_ros.study.paper.cloths import TABLE_10
from cloth_sim_ros.study.paper.printed import edge_count
from cloth_sim_ros.study.paper.printed import printed_speeds
from cloth_sim_ros.study.paper.printed import REAL_TIME
from cloth_sim_ros.study.paper.printed import TABLE
import pytest


def test_each_printed_row_has_its_cloth():
    """A row would be compared with a cloth of other nodes or springs."""
    printed = printed_speeds()
    assert len(printed) == 13
    cloths = (*TABLE_10, *LIMITS)
    assert [cloth.printed for cloth in cloths] == list(printed)


def test_the_printed_speed_up_is_that_of_the_printed_rates():
    """A figure would be copied wrongly, or the misprint taken for a rate."""
    for speed in printed_speeds():
        if speed.cpu_fps is None or speed.gpu_fps is None:
            continue
        # Rates of the CPU are printed as whole numbers: 16 stands for 15.5 to 16.5.
        assert speed.gpu_fps / (speed.cpu_fps + 0.5) - 0.5 <= speed.speed_up
        assert speed.speed_up <= speed.gpu_fps / (speed.cpu_fps - 0.5) + 0.5
    misprinted, = (
        speed for speed in printed_speeds() if speed.source == TABLE and speed.gpu_fps is None)
    assert (misprinted.nodes, misprinted.speed_up) == (802816, 70.0)


@pytest.mark.parametrize('method, mean', [('mass_spring', 61.0), ('constraint', 124.0)])
def test_the_mean_speed_up_is_the_printed_one(method, mean):
    """A row would be lost or changed without any other sign of it."""
    found = [speed.speed_up for speed in printed_speeds()
             if speed.source == TABLE and speed.method == method]
    assert len(found) == 5
    assert sum(found) / 5 == pytest.approx(mean, abs=0.5)


def test_the_printed_cpu_looks_at_pairs_of_constraints():
    """The page would explain the printed speed-up by a cost that the print does not show."""
    pairs = [speed.cpu_fps * speed.springs**2 for speed in printed_speeds()
             if speed.source == TABLE and speed.method == 'constraint']
    print('measured:', *(f'{rate / 1e6:.1f}' for rate in pairs), 'million pairs a second')
    assert max(pairs) < 1.1 * min(pairs)


def test_the_limits_are_real_time():
    """A cloth of section 5 would be compared with a rate that the paper does not name."""
    limits = [speed for speed in printed_speeds() if speed.source != TABLE]
    assert [speed.gpu_fps for speed in limits] == 3 * [REAL_TIME]


@pytest.mark.parametrize('rows, cols', [(2, 2), (3, 7), (12, 12), (1, 5)])
@pytest.mark.parametrize('families', [FAMILIES, FAMILIES[:2], ('bend',)])
def test_edges_are_counted_as_the_scene_has_them(rows, cols, families):
    """Printed counts would be held against those of other grids."""
    scene = Scene({'rows': rows, 'cols': cols, 'material.preset': 'none'})
    edges = edges_of(scene, families)
    assert edge_count(rows, cols, families) == int(edges.of(families).sum())
