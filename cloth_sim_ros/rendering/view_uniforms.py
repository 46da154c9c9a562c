# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Tell a program what the camera sees."""

from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.gl.render_program import RenderProgram


def set_view(program: RenderProgram, view: View, detail: int = 1) -> None:
    """
    Set the uniforms of render/view.glsl in ``program``, which is in use.

    :param detail: drawn pixels along each side of a pixel of the picture
    """
    program.set_matrix('view_matrix', view.matrix)
    program.set_vectors('towards_camera', view.axes[2])
    program.set_pair('half_size', (detail * view.width / 2.0, detail * view.height / 2.0))
