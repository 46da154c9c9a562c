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


"""A picture of the cloth at several times, as a PNG file."""

from collections.abc import Sequence
from pathlib import Path

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.drawing import draw_cloth
from cloth_sim_ros.analysis.drawing import draw_pins
from cloth_sim_ros.analysis.drawing import draw_pushes
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.sheet import Sheet
from cloth_sim_ros.analysis.strain_scale import StrainScale
from cloth_sim_ros.sim.errors import ClothSimError
from matplotlib.backends.backend_agg import FigureCanvasAgg

_DOTS_PER_INCH = 120


def write_picture(
        frames: Sequence[Frame], path: str | Path, *, title: str = '', note: str = '',
        camera: Camera = Camera()) -> None:
    """
    Draw ``frames`` side by side, seen alike, and write them to ``path``.

    :param frames: at least one
    :param note: written below
    :raises ClothSimError: when the file can't be written
    """
    sheet = Sheet(frames, camera)
    scale = StrainScale(frames)
    for axes, frame in zip(sheet.panels, frames):
        sheet.set_up(axes, frame.time)
        sheet.draw_floor(axes)
        draw_cloth(axes, frame, camera, scale)
        draw_pins(axes, frame, camera)
        draw_pushes(axes, frame, camera, sheet.arrow_length)
    figure = sheet.finish(scale, title, note)
    try:
        FigureCanvasAgg(figure).print_figure(path, dpi=_DOTS_PER_INCH, format='png')
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error
