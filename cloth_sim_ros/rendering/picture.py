# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A picture of the cloth at several times, of one recording or of several, as a PNG file."""

from collections.abc import Sequence
from pathlib import Path

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.layout import Layout
from cloth_sim_ros.rendering.layout import panel_size
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.stage import labels_of
from cloth_sim_ros.rendering.stage import note_of
from cloth_sim_ros.rendering.stage import Stage
from cloth_sim_ros.rendering.stage import Style
from cloth_sim_ros.rendering.stage import title_of
from cloth_sim_ros.rendering.strain_scale import StrainScale
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np
from PIL import Image

DEFAULT_PANELS = 6    # of one recording
_DEFAULT_COLUMNS = 4  # of several
_DETAIL = 2


def write_picture(
        sources: Sequence[Source], path: str | Path, *, times: Sequence[float] | None = None,
        style: Style = Style()) -> None:
    """
    Draw ``sources`` at ``times`` and write the picture to ``path``.

    One source fills a grid of panels; several have a row each, or a panel each at one time.

    :param sources: at least one
    :param times: [s], growing; None chooses
    :raises ClothSimError: when a source has no frame, or the file can't be written
    """
    if times is None:
        count = DEFAULT_PANELS if len(sources) == 1 else _DEFAULT_COLUMNS
        # Of several, that with the most to show is asked.
        times = max((source.default_times(count) for source in sources), key=len)
    picture = draw_picture(sources, [source.frames_at(times) for source in sources], style)
    try:
        Image.fromarray(picture).save(path, format='PNG', optimize=True)
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def draw_picture(
        sources: Sequence[Source], rows: Sequence[Sequence[Frame]], style: Style) -> np.ndarray:
    """
    Return the picture of the frames in ``rows``, one row a source, (height, width, 3) uint8.

    :param rows: as many frames each
    """
    survey = Survey()
    frames = [frame for row in rows for frame in row]
    for frame in frames:
        survey.add(frame)
    scale = StrainScale(survey.strains, style.strain_max)
    has_rows = len(rows) > 1 and len(rows[0]) > 1
    columns = len(rows[0]) if has_rows else min(len(frames), style.columns)
    title = title_of(sources, frames) if style.title is None else style.title
    layout = Layout(
        rows=-(-len(frames) // columns), columns=columns,
        panel=style.panel or panel_size(survey.points, style.camera),
        has_title=bool(title), has_labels=has_rows, has_bar=scale.is_known)
    labels = labels_of(sources, style)
    headings = [f't = {frame.time:.2f} s' for frame in frames]
    if len(rows) > 1 and not has_rows:
        headings = [f'{label}, {time}' for label, time in zip(labels, headings)]
    stage = Stage(
        survey, scale, layout, style.camera, title=title, labels=labels, note=note_of(sources),
        detail=_DETAIL)
    try:
        return stage.draw(frames, headings)
    finally:
        stage.close()
