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

"""Draw what stands on the cloth twice: where it is hidden, and where it is seen."""

from collections.abc import Iterator

from OpenGL import GL


def seen_and_hidden(hidden: float) -> Iterator[float]:
    """Set the depth test for each of the two, and yield the opacity to draw with."""
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthMask(GL.GL_FALSE)
    GL.glDepthFunc(GL.GL_GREATER)
    yield hidden
    GL.glDepthFunc(GL.GL_LEQUAL)
    yield 1.0
    GL.glDepthMask(GL.GL_TRUE)
