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


"""Light on a cloth, so that its folds can be seen."""

import numpy as np

_AMBIENT = 0.48
# Over the left shoulder of the camera: right, up and towards it.
_LIGHT = np.array([-0.45, 0.55, 0.70]) / np.linalg.norm([-0.45, 0.55, 0.70])
_GLOSS = 0.12
_GLOSS_POWER = 24
_BACK = 0.85


def shade(colors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """
    Return ``colors`` as they look under the light of the camera.

    :param colors: red, green, blue, alpha from 0 to 1, (n, 4)
    :param normals: as the camera sees them, unit length, (n, 3); both sides are lit alike, the
        back is drawn a little darker
    """
    is_front = normals[:, 2] >= 0.0
    seen = np.where(is_front[:, None], normals, -normals)
    lit = _AMBIENT + (1.0 - _AMBIENT) * np.clip(seen @ _LIGHT, 0.0, 1.0)
    lit = np.where(is_front, lit, _BACK * lit)
    half = _LIGHT + np.array([0.0, 0.0, 1.0])
    gloss = _GLOSS * np.clip(seen @ (half / np.linalg.norm(half)), 0.0, 1.0) ** _GLOSS_POWER
    shaded = colors.copy()
    shaded[:, :3] = np.clip(colors[:, :3] * lit[:, None] + gloss[:, None], 0.0, 1.0)
    return shaded
