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

"""Whether cloth_sim_interfaces, which is there, also works with this Python."""

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.node.missing_module import BUILD_COMMAND
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.type_support import check_for_type_support
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport


def check_interfaces() -> None:
    """Raise ClothSimError when the compiled part of cloth_sim_interfaces can't be loaded."""
    try:
        check_for_type_support(ClothState)
    except UnsupportedTypeSupport as error:
        raise ClothSimError(
            'the package cloth_sim_interfaces is not built for this Python: in your workspace '
            f'run `{BUILD_COMMAND}`') from error
