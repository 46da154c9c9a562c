# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours of the strain on the device."""

from cloth_sim_ros.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.rendering.strain_scale import PALETTE_SIZE
from cloth_sim_ros.rendering.strain_scale import StrainScale
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
