# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The table of the node's own parameters."""

from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene_fields import SCENE_FIELDS
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
