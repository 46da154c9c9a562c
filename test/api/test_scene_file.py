# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Scenes from parameter files, for Python programs."""

from pathlib import Path

from cloth_sim_ros import ClothSimError
from cloth_sim_ros import load_scene
import pytest

DRAPE = Path(__file__).resolve().parents[2] / 'config' / 'studies' / 'two_corners.yaml'


def test_a_shipped_scene_is_read_with_changes():
    """A program would need the file's parameters typed again."""
    scene = load_scene(DRAPE, {'rows': 7, 'publish.rate': 10.0})
    assert (scene.rows, scene.cols, scene['stiffness.structural']) == (7, 48, 1000.0)


@pytest.mark.parametrize('changes', [
    {'row': 7}, {'rows': 'many'}, {'publish.rate': -1.0}, {'rows': 0}])
def test_what_is_wrong_is_named(changes):
    """A misspelt parameter would be passed over, also one of the node."""
    name, = changes
    with pytest.raises(ClothSimError, match=name):
        load_scene(DRAPE, changes)
