# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A body as the rays of a camera meet it: for shaders/include/camera/ray.glsl and dip.glsl."""

from collections.abc import Mapping

from cloth_sim_ros.camera.lens import Lens
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np

# Numbers of size[3] in camera/ray.glsl.
_LENGTHS = 3


def traced_defines(shape: str) -> Mapping[str, str]:
    """Return which functions of camera/ray.glsl are those of a shape."""
    return {'WITHIN': f'within_{shape}', 'OUTWARD': f'outward_{shape}'}


def set_traced_body(
        program: RenderProgram, collider: Collider, lens: Lens, dip: float) -> None:
    """
    Set size and place of a body in ``program``, which is in use.

    :param dip: how deep faces of the cloth may be inside of it [m]
    """
    program.set_floats('size', (*collider.size, *(_LENGTHS - len(collider.size)) * (0.0,)))
    program.set_vectors(
        'body_eye', collider.pose.seen_from(np.array([lens.pose.position])))
    program.set_float('dip', dip)
