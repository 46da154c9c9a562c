# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Warn of bodies so thin that the cloth lets them pass between its nodes."""

import warnings

from cloth_sim_ros.sim.model.colliders import is_thin
from cloth_sim_ros.sim.model.colliders import THIN
from cloth_sim_ros.sim.scene import Scene


def warn_of_thin_bodies(scene: Scene, mode: str) -> None:
    """Warn of the thinnest body, where bodies act on nodes alone."""
    is_paper = scene['layout'] == 'paper' and mode == 'mass_spring'
    if scene['contact.features'] and not is_paper:
        return
    thin = [body for body in scene.colliders if is_thin(body, scene.spacing)]
    if not thin or min(scene.rows, scene.cols) < 2:
        return
    body = min(thin, key=lambda body: body.thickness)
    cell = max(scene.spacing)
    most = body.thickness / THIN
    warnings.warn(
        f'{body.name} is {body.thickness:.3g} m thick, {body.thickness / cell:.2g} of a cell of '
        f'{cell:.3g} m, and can pass between nodes: give contact.features: true and '
        f'layout: fused, or rows and cols for cells of at most {most:.2g} m',
        stacklevel=3)
