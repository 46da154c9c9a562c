# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A disc with a hole, and the same without a GL device."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_GAP
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.snapshot import Snapshot
from made_snapshot import make_snapshot
import numpy as np

CUT = {
    'rows': 13, 'cols': 14, 'width': 0.4, 'height': 0.37, 'shape.disc': 0.37, 'pins': ('none',),
    'shape.holes': (-0.07, -0.05, 0.08, -0.05, 0.08, 0.05, -0.07, 0.05), 'dt': 0.005}


def cut_snapshot(scene: Scene) -> Snapshot:
    """Return ``scene`` at rest, as the device shows it."""
    records = np.zeros((scene.rows, scene.cols), POINT_DTYPE)
    for number, axis in enumerate('xyz'):
        records[axis] = scene.rest_positions()[..., number]
    records['normal_z'] = 1.0
    records['strain'] = 0.03
    for name in POINT_DTYPE.names[:-1]:
        records[name][~scene.present_nodes] = np.nan
    records['flags'][:-1, :-1] = np.where(scene.cells.present, 0, FLAG_GAP)
    records['flags'][~scene.present_nodes] = FLAG_GAP
    return make_snapshot(scene.rows, scene.cols, records=records)


def cut_frame(scene: Scene) -> Frame:
    """Return the same as a frame of a recording."""
    return Frame(1.0, cut_snapshot(scene).records)
