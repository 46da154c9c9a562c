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

"""The colours of the strain on the device."""

from cloth_sim_ros.analysis.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.analysis.rendering.strain_scale import PALETTE_SIZE
from cloth_sim_ros.analysis.rendering.strain_scale import StrainScale
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.render_program import RenderProgram

_UNIT = 1             # render/strain_color.glsl

PALETTE_DEFINES = {'PALETTE_SIZE': PALETTE_SIZE}


class PaletteBuffer:
    """The palette of ``scale``, for render/strain_color.glsl."""

    def __init__(self, scale: StrainScale) -> None:
        """Write it to the device."""
        self._full = scale.full
        self._buffer = Buffer(scale.palette)

    def give(
            self, program: RenderProgram,
            plain: tuple[float, float, float] = UNKNOWN_COLOR) -> None:
        """
        Let ``program``, which is in use, take its colours from here.

        :param plain: the colour of what has no strain
        """
        self._buffer.bind_texture(_UNIT)
        program.set_float('full_strain', self._full)
        program.set_vectors('plain_color', plain)
