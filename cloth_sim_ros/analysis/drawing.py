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


"""Draw the cloth of one frame into matplotlib axes; a renderer can take the place of this."""

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.resampling import resampled
from cloth_sim_ros.analysis.shading import shade
from cloth_sim_ros.analysis.strain_scale import StrainScale
from cloth_sim_ros.messages.triangles import triangles
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.collections import PolyCollection
from matplotlib.patheffects import withStroke
import numpy as np

PIN_COLOR = '#d62020'
PUSH_COLOR = '#1560e0'
SIDE = 130           # places drawn along a side: more are hardly larger than a pixel
_WORDS_BEYOND = 0.2  # of an arrow, over its length


def draw_cloth(axes: Axes, frame: Frame, camera: Camera, scale: StrainScale) -> None:
    """Draw the surface coloured by strain, the far parts first."""
    seen = camera.project(resampled(frame.positions, SIDE))
    colors = scale.colors(resampled(frame.strain, SIDE)).reshape(-1, 4)
    rows, cols = seen.shape[:2]
    seen = seen.reshape(-1, 3)
    if min(rows, cols) == 1:
        pairs = np.stack([seen[:-1, :2], seen[1:, :2]], axis=1)
        axes.add_collection(LineCollection(pairs, colors=colors[1:], linewidths=2.0))
        return
    normals = camera.project(resampled(frame.normals, SIDE)).reshape(-1, 3)
    faces = triangles(rows, cols)
    middle = normals[faces].mean(axis=1)
    middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)
    looks = shade(colors[faces].mean(axis=1), middle)
    order = np.argsort(seen[faces, 2].mean(axis=1))
    axes.add_collection(PolyCollection(
        seen[faces[order], :2], facecolors=looks[order], edgecolors=looks[order],
        linewidths=0.3))


def draw_pins(axes: Axes, frame: Frame, camera: Camera) -> None:
    """Mark the nodes that are held."""
    seen = camera.project(frame.positions[frame.pinned])
    axes.scatter(
        seen[:, 0], seen[:, 1], s=22, color=PIN_COLOR, edgecolors='white', linewidths=0.7,
        zorder=4)


def draw_pushes(axes: Axes, frame: Frame, camera: Camera, length: float) -> None:
    """
    Draw an arrow with its force for each push that acts.

    :param length: of the arrow of the largest push [m]
    """
    for push, arrow in zip(frame.acting_pushes, frame.push_arrows(length)):
        tail, tip = camera.project(arrow)[:, :2]
        axes.annotate(
            '', tip, tail, zorder=5,
            arrowprops={'arrowstyle': '-|>,head_width=0.35,head_length=0.7', 'linewidth': 2.2,
                        'color': PUSH_COLOR, 'shrinkA': 0.0, 'shrinkB': 0.0})
        axes.text(
            *(tip + _WORDS_BEYOND * length * _direction(tip - tail)),
            f'{np.linalg.norm(push.force):.3g} N', color=PUSH_COLOR, fontsize=9,
            fontweight='bold', ha='center', va='center', zorder=5,
            path_effects=[withStroke(linewidth=2.0, foreground='white')])


def _direction(vector: np.ndarray) -> np.ndarray:
    # A push towards the camera is a point in the view: its words go above it.
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0.0 else np.array([0.0, 1.0])
