# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Random look and place of a camera, for pictures that a detector is trained on."""

from __future__ import annotations

from collections.abc import Sequence
import colorsys
from dataclasses import replace
import math

from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.cameras import looking_at
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Color
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.model.scene_fields import FABRICS
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

Range = tuple[float, float]

# Default ranges of a camera's distance from the cloth [m] and elevation above the horizon [deg].
DISTANCE: Range = (0.6, 1.2)
ELEVATION: Range = (25.0, 80.0)
# Widest ranges.
_DISTANCES = (0.05, 1e3)
_ELEVATIONS = (-89.0, 89.0)
# Ranges of looks: value of colours [1], pitch of patterns [m], tilt of the sun [rad], radius of
# the soft edge of shadows [m].
_VALUES = (0.25, 0.95)
_PITCHES = (0.01, 0.05)
_SUN_TILTS = (0.0, 1.1)
_SHADOWS = (0.004, 0.02)
# Largest distance of the target from the middle of the cloth, over that of the camera [1].
_OFF_TARGET = 0.08


def randomise(
        camera: CameraModel, cloth: Simulation | Snapshot, *, seed: int | np.random.Generator,
        distance: Sequence[float] = DISTANCE, elevation: Sequence[float] = ELEVATION,
        colliders: Sequence[Collider] | None = None) -> tuple[CameraModel, Look]:
    """
    Return ``camera`` at a random place that looks at ``cloth``, and a random look.

    All values are drawn evenly from their ranges. The look has random colours of cloth, colliders
    and background, a random fabric and sun, and the images of the scene's look. The same seed and
    state give the same values.

    :param seed: 0 or more, or a generator, which is drawn from
    :param distance: least and largest distance of the camera from the middle of the cloth [m]
    :param elevation: least and largest elevation above the horizon, seen from there [deg]
    :param colliders: that get a colour; by default those of a Simulation
    :raises ClothSimError: for a wrong value
    """
    instance(camera, CameraModel, 'the camera to randomise', 'give one of Scene.cameras')
    subject = Subject.of(cloth, colliders)
    near, far = _checked_range(distance, 'distance', 'm', _DISTANCES)
    low, high = _checked_range(elevation, 'elevation', 'deg', _ELEVATIONS)
    random = _generator(seed)
    nodes = subject.nodes()
    placed = _placed(
        random, camera, nodes[np.isfinite(nodes).all(axis=-1)], (near, far), (low, high))
    return placed, _look(random, subject.colliders, subject.look)


def _generator(seed: int | np.random.Generator) -> np.random.Generator:
    if isinstance(seed, np.random.Generator):
        return seed
    number = integer(seed, 'the seed of randomise', 'give an int from 0, or a Generator')
    if number < 0:
        raise ClothSimError(
            f'the seed of randomise must be 0 or more, got {number}: give an int from 0')
    return np.random.default_rng(number)


def _checked_range(given: Sequence[float], name: str, unit: str, widest: Range) -> Range:
    least, most = vector(
        given, f'the {name} of randomise', unit, length=2, hint='give the least and the largest')
    if not widest[0] <= least <= most <= widest[1]:
        raise ClothSimError(
            f'the {name} of randomise must be two numbers from {widest[0]:g} to {widest[1]:g} '
            f'{unit}, the lower one first, got {least:g} and {most:g}: give such a range')
    return least, most


def _placed(
        random: np.random.Generator, camera: CameraModel, nodes: np.ndarray, distances: Range,
        elevations: Range) -> CameraModel:
    """
    Return ``camera`` where it looks at the cloth from a random direction.

    :param nodes: (n, 3) [m]
    """
    distance = random.uniform(*distances)
    elevation = math.radians(random.uniform(*elevations))
    azimuth = random.uniform(0.0, 2.0 * math.pi)
    middle = nodes.mean(axis=0)
    target = middle + random.uniform(-_OFF_TARGET, _OFF_TARGET, 3) * distance
    x, y, z = middle + distance * np.array([
        math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation)])
    pose = looking_at((float(x), float(y), float(z)), target.tolist())
    return replace(camera, pose=pose, frame='')


def _look(random: np.random.Generator, colliders: Sequence[Collider], base: Look) -> Look:
    """Return a random look with the images of ``base``."""
    tilt, turn = random.uniform(*_SUN_TILTS), random.uniform(0.0, 2.0 * math.pi)
    color = _color(random)
    hue, saturation, value = colorsys.rgb_to_hsv(*color)
    # The back of a fabric has mostly the dye of its front.
    back = colorsys.hsv_to_rgb(hue, saturation * random.uniform(0.4, 1.0), value)
    return Look(
        texture=base.texture, backdrop=base.backdrop, fabric=str(random.choice(FABRICS)),
        color=color, back_color=back,
        second_color=_color(random), pitch=float(random.uniform(*_PITCHES)),
        background=_color(random),
        sun=(math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt)),
        shadow=float(random.uniform(*_SHADOWS)),
        bodies={collider.name: _color(random) for collider in colliders})


def _color(random: np.random.Generator) -> Color:
    """Return a random colour, pale ones as often as strong ones."""
    return colorsys.hsv_to_rgb(
        random.uniform(0.0, 1.0), random.uniform(0.0, 0.8), random.uniform(*_VALUES))
