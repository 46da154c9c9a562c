# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of the cloth at several times, as a PNG file: of recordings, and of runs in rows."""

from collections.abc import Sequence
from pathlib import Path

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import RunOutcome
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import write_words
from cloth_sim_ros.rendering.renderer import draw_panel
from cloth_sim_ros.rendering.renderer import has_bar
from cloth_sim_ros.rendering.renderer import labels_of
from cloth_sim_ros.rendering.renderer import note_of
from cloth_sim_ros.rendering.renderer import Renderer
from cloth_sim_ros.rendering.renderer import Stage
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.renderer import title_of
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.sheet import panel_size
from cloth_sim_ros.rendering.sheet import Sheet
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.survey import Extent
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
        # The source with the most panels sets the times of all.
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
        has_title=bool(title), has_labels=has_rows, has_bar=has_bar(scale, style))
    labels = labels_of(sources, style)
    headings = [f't = {frame.time:.2f} s' for frame in frames]
    if len(rows) > 1 and not has_rows:
        headings = [f'{label}, {time}' for label, time in zip(labels, headings)]
    stage = Stage(
        survey, scale, layout, style.camera, title=title, labels=labels, note=note_of(sources),
        detail=_DETAIL, look=style.look)
    try:
        return stage.draw(frames, headings)
    finally:
        stage.close()


# A sheet of runs, a row each, some of which may have blown up.

_PANEL = (244, 186)   # [pixel]
_STRAIN_MAX = 0.2     # of the last colour: twice the limit of the adaptive mode
_TORN = 1.0           # from this strain on, a cloth does not set what the camera shows
_CAMERA = Camera(elevation=18.0)
_WITH_WORDS = 1.2     # room for an arrow and its words, over its length
_WHITE = 255


def write_run_sheet(
        path: str | Path, runs: Sequence[tuple[str, Recording, RunOutcome]],
        times: Sequence[float], title: str, camera: Camera = _CAMERA) -> None:
    """
    Draw ``runs`` at ``times`` [s] and write the picture to ``path``.

    A panel later than the end of a run that stopped shows text instead of a cloth. The view fits
    the runs that did not blow up; nodes of the others outside it are not drawn.

    :param runs: label, recording and outcome of each
    :raises ClothSimError: when the file can't be written
    """
    rows = [_shown(recording, outcome, times) for _, recording, outcome in runs]
    survey = Survey()
    frames = [frame for row in rows for frame in row if frame is not None]
    starts = [next(read_frames(recording)) for _, recording, _ in runs]
    whole = starts + [frame for frame in frames if frame.strain[frame.present].max() <= _TORN]
    for frame in whole:
        survey.add(frame)
    for frame in frames:
        survey.strains.add(frame.strain)
    scale = StrainScale(survey.strains, _STRAIN_MAX)
    layout = Layout(
        rows=len(rows), columns=len(times), panel=_PANEL, has_labels=True)
    view = camera.looking_at(_in_view(survey, whole), *layout.panel)
    sheet = Sheet(
        layout, survey, scale, view, title=title, labels=[label for label, *_ in runs],
        note=_made_on([outcome for *_, outcome in runs]))
    renderer = Renderer(survey, scale, view, _DETAIL)
    try:
        images = [
            _ended(layout, outcome) if frame is None
            else draw_panel(renderer, survey, frame, layout.font)
            for row, (*_, outcome) in zip(rows, runs) for frame in row]
    finally:
        renderer.close()
    headings = [
        f't = {time if frame is None else frame.time:.2f} s'
        for row in rows for time, frame in zip(times, row)]
    picture = sheet.compose(images, headings)
    try:
        Image.fromarray(_coarser(picture)).save(path, format='PNG', optimize=True)
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def _coarser(picture: np.ndarray) -> np.ndarray:
    """Return the picture in steps of 4 of 255: nobody sees them, and the file is 0.6 as large."""
    return np.minimum((picture.astype(np.uint16) + 2) // 4 * 4, _WHITE).astype(np.uint8)


def _made_on(outcomes: Sequence[RunOutcome]) -> str:
    devices = dict.fromkeys(outcome.device for outcome in outcomes if outcome.device)
    return f'simulated on {", ".join(devices)}' if devices else ''


def _shown(
        recording: Recording, outcome: RunOutcome, times: Sequence[float]) -> list[Frame | None]:
    frames = frames_at(recording, times)
    return [
        None if outcome.stopped and time > outcome.end else frame
        for time, frame in zip(times, frames)]


def _in_view(survey: Survey, frames: Sequence[Frame]) -> np.ndarray:
    """Return points around all cloths and arrows; the floor may be cut."""
    extent = Extent()
    for frame in frames:
        extent.add_nodes(frame.positions)
        for tail, tip in survey.arrows(frame):
            extent.add(tail + _WITH_WORDS * (tip - tail))
    return extent.points


def _ended(layout: Layout, outcome: RunOutcome) -> np.ndarray:
    width, height = layout.panel
    image = np.full((height, width, 3), _WHITE, np.uint8)
    words = [f'not finite after {outcome.end:.3g} s']
    if outcome.stability_margin > 1.0:
        words.append(f'substep {outcome.stability_margin:.2f} x its limit')
    for line, text in enumerate(words):
        place = width / 2.0, height / 2.0 + 1.4 * layout.font * (line - (len(words) - 1) / 2.0)
        write_words(image, text, place, layout.font)
    return image
