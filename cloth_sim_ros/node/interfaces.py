# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
