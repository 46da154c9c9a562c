# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Layouts cover every node once, suit the device, and refuse what does not fit."""

from types import SimpleNamespace

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS


def device(**changed: object) -> SimpleNamespace:
    """Return what a layout needs to know of a device."""
    return SimpleNamespace(**{
        'device': 'some GPU', 'version': '4.6', 'is_software': False, 'max_buffer_bytes': 2**27,
        'max_texture_texels': 2**27, **changed})


@pytest.mark.parametrize('block', [1, 2, 4])
def test_nodes_are_stored_with_two_ghosts_around(block: int):
    """A neighbour two places away would be read from another row."""
    layout = Layout(5, 7, 'fused', True, block, (8, 4))
    stored = layout.store(np.arange(1, 36, dtype=np.int64).reshape(5, 7))
    assert stored.size == layout.stored
    assert stored.ravel()[layout.index(4, 6)] == 35
    assert np.count_nonzero(stored) == 35
    for border in (stored[:2], stored[7:], stored[:, :2], stored[:, 9:]):
        assert not border.any()


@pytest.mark.parametrize(('rows', 'cols', 'block'), [(1, 2, 4), (5, 7, 1), (6, 3, 2)])
def test_what_is_stored_comes_back_at_its_node(rows: int, cols: int, block: int):
    """The results of a node would be reported for another."""
    layout = Layout(rows, cols, 'fused', True, block, (8, 4))
    values = np.random.default_rng(1).normal(size=(rows, cols, 4))
    stored = layout.store(values).reshape(layout.stored, 4)
    assert np.array_equal(layout.load(stored), values)


@pytest.mark.parametrize(('rows', 'cols', 'block'), [(1, 2, 4), (33, 65, 2), (64, 64, 4)])
def test_workgroups_reach_every_node(rows: int, cols: int, block: int):
    """The last rows or columns of the cloth would stand still."""
    layout = Layout(rows, cols, 'fused', True, block, (8, 4))
    across, down = layout.groups
    assert across * 8 * block >= cols
    assert down * 4 * block >= rows


def test_software_devices_read_textures():
    """A software device would run at a fraction of its speed."""
    scene = Scene()
    assert choose_layout(scene, device(is_software=True)).texture_loads
    assert not choose_layout(scene, device()).texture_loads
    assert choose_layout(Scene({**SPRINGS, 'loads': 'texture'}), device()).texture_loads


@pytest.mark.parametrize(('rows', 'cols', 'block'), [
    (9, 17, 4), (200, 200, 4), (200, 16, 2), (8, 200, 2), (2, 2, 2)])
def test_blocks_on_software_leave_no_half_workgroup_idle(rows: int, cols: int, block: int):
    """A small or narrow cloth would step a fifth to two fifths slower."""
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols})
    assert choose_layout(scene, device(is_software=True)).block == block
    assert choose_layout(scene, device()).block == 1


def test_cloth_beyond_the_buffer_limit_is_refused():
    """The device would cut the cloth off, or crash."""
    with pytest.raises(DeviceError) as caught:
        choose_layout(
            Scene({**SPRINGS, 'rows': 4000, 'cols': 4000, 'auto_substeps': False}),
            device(device='tiny'))
    message = str(caught.value)
    assert 'rows 4000 x cols 4000 need' in message
    assert 'the buffers of tiny hold 8388608: use up to about 2891 x 2891' in message


def test_compensated_sums_have_a_limit_of_their_own():
    """Beyond it a large cloth would lose its low parts, and fall too slowly."""
    values = {**SPRINGS, 'rows': 2400, 'cols': 2400, 'auto_substeps': False}
    for is_software in (True, False):
        choose_layout(Scene({**values, 'dt': 1e-3}), device(is_software=is_software))
        with pytest.raises(DeviceError, match='hold 5592405: use up to about 23[0-9]{2} x 23'):
            choose_layout(Scene({**values, 'dt': 1e-7}), device(is_software=is_software))
    stacked = choose_layout(Scene({**SPRINGS, 'rows': 8, 'cols': 8, 'dt': 1e-7}), device())
    with pytest.raises(DeviceError, match='hold 5592405'):
        stacked.stacked(50_000, device())


def test_small_texture_limits_count_only_for_texture_loads():
    """A device with small textures would refuse cloth that its storage blocks can hold."""
    small = device(max_texture_texels=2**16)
    values = {'rows': 1000, 'cols': 1000}
    choose_layout(Scene({**SPRINGS, **values, 'loads': 'storage'}), small)
    with pytest.raises(DeviceError):
        choose_layout(Scene({**SPRINGS, **values, 'loads': 'texture'}), small)


@pytest.mark.parametrize('choice', [{'loads': 'texture'}, {'block': 4}])
def test_the_papers_layout_stays_the_papers(choice: dict):
    """A benchmark would compare with something the paper does not do."""
    with pytest.raises(ClothSimError, match='layout paper reads storage'):
        choose_layout(Scene({**SPRINGS, 'layout': 'paper', **choice}), device())
