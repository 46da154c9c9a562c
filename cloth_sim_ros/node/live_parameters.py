# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters that a running node accepts: checked as a whole, then put to work."""

from collections.abc import Callable
from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.parameters import as_field_type
from cloth_sim_ros.node.parameters import FIELD_OF
from cloth_sim_ros.node.parameters import plain_value
from cloth_sim_ros.sim.errors import ClothSimError
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


class LiveParameters:
    """
    Check and apply changes of parameters while the node runs.

    :param values: parameter values by name, kept up to date here
    :param ask_mode: asks for another mode; a ClothSimError is the reason of the rejection
    :param changed: called with the parameters after each accepted change
    """

    def __init__(
            self, node: Node, values: dict[str, Any], *, ask_mode: Callable[[str], None],
            changed: Callable[[Sequence[Parameter]], None]) -> None:
        """Register with ``node``."""
        self._values = values
        self._ask_mode = ask_mode
        self._changed = changed
        node.add_pre_set_parameters_callback(_with_field_types)
        node.add_on_set_parameters_callback(self._on_set)
        node.add_post_set_parameters_callback(self._after_set)

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        try:
            checked = {
                parameter.name: FIELD_OF[parameter.name].check(plain_value(parameter))
                for parameter in parameters if parameter.name in FIELD_OF}
            check_together({**self._values, **checked})
            # Last, because it is the only one that can still fail, and nothing may change then.
            if 'mode' in checked:
                self._ask_mode(checked['mode'])
        except ClothSimError as error:
            return SetParametersResult(successful=False, reason=str(error))
        self._values.update(checked)
        return SetParametersResult(successful=True)

    def _after_set(self, parameters: list[Parameter]) -> None:
        own = [parameter for parameter in parameters if parameter.name in FIELD_OF]
        if own:
            self._changed(own)


def _with_field_types(parameters: list[Parameter]) -> list[Parameter]:
    return [as_field_type(parameter) for parameter in parameters]
