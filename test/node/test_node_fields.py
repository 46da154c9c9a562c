# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The table of the node's own parameters."""

from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
import pytest

DEFAULTS = {field.name: field.default for field in NODE_FIELDS}


@pytest.mark.parametrize('field', NODE_FIELDS, ids=lambda field: field.name)
def test_defaults_keep_to_their_own_rules(field):
    """A node without a parameter file would refuse to start."""
    assert field.check(field.default) == field.default


def test_names_are_unique():
    """A parameter would be declared twice, and the node could not start."""
    names = [field.name for field in SCENE_FIELDS + NODE_FIELDS]
    assert len(names) == len(set(names))


def test_clicked_force_needs_three_components():
    """A click would push with half a vector."""
    check_together(DEFAULTS)
    with pytest.raises(ClothSimError, match='3 components, got 2'):
        check_together({**DEFAULTS, 'clicked_point.force': (1.0, 2.0)})
