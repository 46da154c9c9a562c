# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths of known shape, and a renderer for them."""

from collections.abc import Callable
from collections.abc import Iterator

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.daylight import STRAIN
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.renderer import Renderer
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import numpy as np
import pytest
from recording_fixtures import hanging  # noqa: F401
from recording_fixtures import known  # noqa: F401

ABOVE = Camera(-90.0, 90.0, 0.0)  # x to the right, y up, no perspective
FULL = 0.05                       # strain of the last colour


@pytest.fixture
def flat() -> Callable[..., Frame]:
    """Return a function that makes a frame: a level square metre at z = 0."""

    def make(rows: int = 9, cols: int = 9, strain: float = 0.03, pushes: tuple = ()) -> Frame:
        records = np.zeros((rows, cols), POINT_DTYPE)
        records['x'] = np.linspace(-0.5, 0.5, cols)
        records['y'] = np.linspace(0.5, -0.5, rows)[:, None]
        records['normal_z'] = 1.0
        records['strain'] = strain
        return Frame(1.0, records, pushes)

    return make


@pytest.fixture
def rendered() -> Iterator[Callable[..., tuple]]:
    """Return a function that draws a frame, and returns the image and the renderer."""
    renderers = []

    def draw(
            frame: Frame, camera: Camera = ABOVE, width: int = 160, height: int = 120,
            detail: int = 1, look: str = STRAIN) -> tuple[np.ndarray, Renderer]:
        survey = Survey()
        survey.add(frame)
        view = camera.looking_at(survey.points, width, height)
        renderer = Renderer(survey, StrainScale(survey.strains, FULL), view, detail, look)
        renderers.append(renderer)
        return renderer.draw(frame).astype(int), renderer

    yield draw
    for renderer in renderers:
        renderer.close()
