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

"""Plain values of recorded parameters."""

from typing import Any

# By the numbers of rcl_interfaces/msg/ParameterType.
_SLOTS = {
    1: ('bool_value', bool), 2: ('integer_value', int), 3: ('double_value', float),
    4: ('string_value', str)}
_ARRAY_SLOTS = {
    6: ('bool_array_value', bool), 7: ('integer_array_value', int),
    8: ('double_array_value', float), 9: ('string_array_value', str)}


def plain_value(value: Any) -> Any:
    """Return what the decoded ParameterValue ``value`` holds; None for what no parameter has."""
    if value.type in _SLOTS:
        slot, kind = _SLOTS[value.type]
        return kind(getattr(value, slot))
    if value.type in _ARRAY_SLOTS:
        slot, kind = _ARRAY_SLOTS[value.type]
        try:
            return [kind(part) for part in getattr(value, slot)]
        except (TypeError, ValueError):  # of a type that the bag has defined in another way
            return None
    return None
