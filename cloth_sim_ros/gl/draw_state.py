# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What decides whether a drawn pixel is seen: what is there already, and on which side it is."""

from cloth_sim_ros.gl.libraries import GL


def blend_by_opacity() -> None:
    """Let colours cover what is there by their fourth part."""
    GL.glEnable(GL.GL_BLEND)
    GL.glBlendFunc(GL.GL_SRC_ALPHA, GL.GL_ONE_MINUS_SRC_ALPHA)


def draw_over_all() -> None:
    """Draw over what is there, however near it is, and hide nothing that comes."""
    GL.glDisable(GL.GL_DEPTH_TEST)


def draw_nearest(*, hides: bool = True) -> None:
    """
    Draw what no other part hides.

    :param hides: hide what comes later and is farther away
    """
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_LEQUAL)
    GL.glDepthMask(hides)


def draw_hidden() -> None:
    """Draw what other parts hide, and nothing else."""
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_GREATER)
    GL.glDepthMask(False)


def draw_clockwise_only(is_on: bool) -> None:
    """Leave out triangles that run counter-clockwise in the picture, or no longer do."""
    if is_on:
        GL.glEnable(GL.GL_CULL_FACE)
        GL.glCullFace(GL.GL_FRONT)
    else:
        GL.glDisable(GL.GL_CULL_FACE)
