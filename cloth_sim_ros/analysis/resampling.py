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


"""The nodes of a cloth made more or fewer for drawing."""

import numpy as np


def resampled(values: np.ndarray, side: int) -> np.ndarray:
    """
    Return ``values`` at about ``side`` places along each side, with straight lines between nodes.

    A coarse cloth keeps its nodes and gets places between them; a side of one node stays so.

    :param values: (rows, cols, ...)
    :param side: most places along a side, 2 or more
    """
    for axis in (0, 1):
        values = _resampled_along(values, axis, side)
    return values


def _resampled_along(values: np.ndarray, axis: int, side: int) -> np.ndarray:
    count = values.shape[axis]
    if count == 1:
        return values
    places = (side - 1) // (count - 1) * (count - 1) + 1 if count <= side else side
    where = np.linspace(0.0, count - 1.0, places)
    before = np.minimum(where.astype(int), count - 2)
    share = (where - before).reshape(-1, *(1,) * (values.ndim - axis - 1))
    return (
        (1.0 - share) * values.take(before, axis) + share * values.take(before + 1, axis))
