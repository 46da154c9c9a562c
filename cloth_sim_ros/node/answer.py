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

"""Turn a request that cannot be carried out into a service answer that says why."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError


def answer(carry_out: Callable[[Any, Any], str]) -> Callable[[Any, Any], Any]:
    """
    Return a service callback around ``carry_out(request, response) -> message``.

    A ClothSimError becomes success false with its reason; every service of the node has the
    response fields success and message.
    """
    def callback(request: Any, response: Any) -> Any:
        try:
            response.message = carry_out(request, response)
            response.success = True
        except ClothSimError as error:
            response.message = str(error)
            response.success = False
        return response

    return callback
