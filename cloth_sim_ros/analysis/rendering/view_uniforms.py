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

"""Tell a program what the camera sees."""

from cloth_sim_ros.analysis.rendering.view import View
from cloth_sim_ros.gl.render_program import RenderProgram


def set_view(program: RenderProgram, view: View, detail: int = 1) -> None:
    """
    Set the uniforms of render/view.glsl in ``program``, which is in use.

    :param detail: drawn pixels along each side of a pixel of the picture
    """
    program.set_matrix('view_matrix', view.matrix)
    program.set_vectors('towards_camera', view.axes[2])
    program.set_pair('half_size', (detail * view.width / 2.0, detail * view.height / 2.0))
