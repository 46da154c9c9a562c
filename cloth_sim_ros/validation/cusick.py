# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The drape test of Cusick on measured fabrics: drape coefficients beside published ones.

A disc of 30 cm lies on a plate of 18 cm, config/cusick.yaml. The drape coefficient is the area of
its shadow beyond the plate, over that of the flat disc (ISO 9073-9). Nothing is fitted: weight,
stretch and bending are those that were measured.
"""

from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.validation.row import Figure
import numpy as np
from PIL import Image
from PIL import ImageDraw

# The linear part of the first fabric of the data set of Feng et al. 2022,
# DOI 10.1145/3550454.3555464, which has the weight of silk; its fibre is not given.
_LIGHT = {
    'material.preset': 'none', 'areal_density': 0.0673, 'bending.rigidity': (1.78e-6, 3.08e-6),
    # Not measured there: hardly any stretch, and shear as that of the tablecloth.
    'material.warp': 2000.0, 'material.weft': 2000.0, 'material.shear': 5.0}
# What is simulated, fabrics of its kind, and the drape coefficients that are published for them
# [%].
FABRICS: dict[str, tuple[dict[str, Any], str, tuple[float, float]]] = {
    'light': (_LIGHT, 'silk', (20.0, 40.0)),
    't_shirt': ({'material.preset': 't_shirt'}, 'cotton', (60.0, 76.0)),
    'trousers': ({'material.preset': 'trousers'}, 'cotton', (60.0, 76.0)),
    'denim': ({'material.preset': 'denim'}, 'denim', (70.0, 90.0)),
}
_PLATE = 0.09           # radius [m]
_PIXEL = 1e-4           # [m]
_LOOK = 0.25            # simulated time between two looks [s]
# Change of the drape coefficient between two looks [1], below which the cloth is at rest.
_STILL = 5e-4


def shadow(snapshot: Snapshot) -> np.ndarray:
    """Return the shadow of a lamp far above, (pixels, pixels) bool."""
    mesh = snapshot.mesh()
    reach = 0.17
    side = round(2.0 * reach / _PIXEL)
    image = Image.new('1', (side, side))
    draw = ImageDraw.Draw(image)
    flat = (mesh.vertices[:, :2].astype(float) + reach) / _PIXEL
    for corners in flat[mesh.triangles]:
        draw.polygon([tuple(corner) for corner in corners.tolist()], fill=1)
    return np.asarray(image)


def drape_coefficient(covered: np.ndarray, flat: np.ndarray) -> float:
    """Return how much of the flat cloth beyond the plate is in the shadow."""
    plate = np.pi * _PLATE**2 / _PIXEL**2
    return float((covered.sum() - plate) / (flat.sum() - plate))


def drape(
        nodes: int, seconds: float, context: Context | None = None,
        **changes: Any) -> tuple[float, float]:
    """Return the drape coefficient, and the simulated time at rest, at most ``seconds`` [s]."""
    values = {
        **load_parameters(shared_directory('config') / 'cusick.yaml'), 'rows': nodes,
        'cols': nodes, **changes}
    with Simulation(Scene(values), context=context) as simulation:
        flat = shadow(simulation.snapshot())
        before = found = 1.0
        while simulation.time < seconds:
            simulation.advance(_LOOK)
            before = found
            found = drape_coefficient(shadow(simulation.snapshot()), flat)
            if simulation.time > 1.0 and abs(found - before) < _STILL:
                break
        return found, simulation.time


def coefficient(context: Context, mode: str, nodes: int, fabric: str) -> Figure:
    """Return the drape coefficient after 10 s at most, beside the published range [%]."""
    changes, _, published = FABRICS[fabric]
    return Figure(100.0 * drape(nodes, 10.0, context, mode=mode, **changes)[0], *published)
