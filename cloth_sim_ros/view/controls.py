# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The controls of a page, and the text beside the cloth."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.camera.rig import COLOR
from cloth_sim_ros.camera.rig import DEPTH
from cloth_sim_ros.messages.geometry import FULL_STRAIN
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.view.source import Moment
from cloth_sim_ros.view.source import RUNNING
from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.surface import band_colors
import numpy as np
import viser

_PUSH, _PIN = 'pushes', 'pins or releases'
_PAUSE, _RESUME = 'Pause', 'Run'
# No name of a camera has a blank.
_NO_CAMERA = 'no camera'
_PARTS = {'colour': COLOR, 'depth': DEPTH}
_NO_PICTURE = np.zeros((1, 1, 3), np.uint8)


class Controls:
    """
    The controls.

    :param answer: does an action for a page, and tells it what is wrong
    """

    def __init__(
            self, server: viser.ViserServer, source: Source,
            answer: Callable[[Any, Callable[[], Any]], None]) -> None:
        """Build the controls that ``source`` has a use for."""
        self._gui = server.gui
        self._source = source
        self._answer = answer
        self._is_running = True
        self._shown_mode = ''
        self._picture: Any = None
        self._shown_picture: np.ndarray | None = None
        self._told = self._gui.add_markdown('')
        self._add_time()
        self._add_mode()
        self._strain = self._gui.add_number(
            'Colour scale ends at strain [%]', 100.0 * FULL_STRAIN, min=0.01, max=1000.0,
            step=0.01)
        self._gui.add_html(_legend())
        if source.cameras:
            self._add_camera()
        if source.can_act:
            self._add_actions()

    @property
    def full_strain(self) -> float:
        """Get the strain that the last colour stands for."""
        return _value(self._strain) / 100.0

    @property
    def shows_handles(self) -> bool:
        """Return whether pins have handles."""
        return bool(self._handles.value)

    @property
    def click_pushes(self) -> bool:
        """Return whether a click pushes; otherwise it pins a node or lets it go."""
        return self._click.value == _PUSH

    @property
    def push_force(self) -> float:
        """Get the total force of a push [N]."""
        return _value(self._force)

    @property
    def push_radius(self) -> float:
        """Get how far around a click a push acts [m]."""
        return _value(self._radius)

    @property
    def push_duration(self) -> float:
        """Get how long a push lasts [s]."""
        return _value(self._duration)

    def show(self, moment: Moment) -> None:
        """Show the figures of ``moment``."""
        frame = moment.frame
        note = f'\n\n**{moment.note}**' if moment.note else ''
        self._tell(
            f'**{self._source.name}**, {moment.run_state}\n\n'
            f't = {frame.time:.2f} s, largest strain {100.0 * np.nanmax(frame.strain):.1f} %, '
            f'{np.count_nonzero(frame.pinned)} pins\n\n'
            f'mode {moment.mode or "not known"}{note}')
        self._is_running = moment.run_state == RUNNING
        label = _PAUSE if self._is_running else _RESUME
        if self._pause.label != label:
            self._pause.label = label
        # A choice that is being made is not taken back before it had its effect.
        if self._mode is not None and self._shown_mode != moment.mode:
            self._mode.value = self._shown_mode = moment.mode
        if self._source.cameras and self._shown_picture is not moment.picture:
            self._shown_picture = moment.picture
            self._picture.visible = moment.picture is not None
            if moment.picture is not None:
                self._picture.image = moment.picture
        if self._time is not None and self._is_running:
            self._time.value = frame.time

    def _tell(self, text: str) -> None:
        if self._told.content != text:
            self._told.content = text

    def _add_time(self) -> None:
        self._pause = self._gui.add_button(_PAUSE)
        self._pause.on_click(lambda event: self._answer(
            event.client, lambda: self._source.set_paused(self._is_running)))
        # The types of viser take the value of a handle for one that cannot be set.
        self._time: Any = None
        if self._source.span is not None:
            begin, end = self._source.span
            self._time = self._gui.add_slider(
                'Time [s]', begin, max(end, begin + 1e-3), 1e-3, begin)
            self._when_set(self._time, self._source.go_to)
        if self._source.can_act:
            self._button('Step', lambda: self._source.step(1))
            self._button('Reset', self._source.reset)

    def _add_mode(self) -> None:
        self._mode: Any = None
        if self._source.modes:
            self._mode = self._gui.add_dropdown('Mode', self._source.modes)
            self._when_set(self._mode, self._switch)

    def _switch(self, mode: str) -> None:
        try:
            self._source.set_mode(mode)
        except ClothSimError:
            self._mode.value = self._shown_mode
            raise

    def _add_camera(self) -> None:
        with self._gui.add_folder('What a camera sees'):
            self._camera: Any = self._gui.add_dropdown(
                'Camera', (_NO_CAMERA, *self._source.cameras))
            self._shown_camera = _NO_CAMERA
            self._part: Any = self._gui.add_dropdown('Picture', tuple(_PARTS))
            self._picture = self._gui.add_image(_NO_PICTURE, label='Seen', visible=False)
        for choice in (self._camera, self._part):
            self._when_set(choice, lambda _: self._choose_camera())

    def _choose_camera(self) -> None:
        name = self._camera.value
        try:
            self._source.show_camera(
                '' if name == _NO_CAMERA else name, _PARTS[self._part.value])
        except ClothSimError:
            self._camera.value = self._shown_camera
            raise
        self._shown_camera = name

    def _add_actions(self) -> None:
        with self._gui.add_folder('A click on the cloth'):
            self._click = self._gui.add_dropdown('Click', (_PUSH, _PIN))
            self._force = self._gui.add_number('Force [N]', 1.0, min=0.0, max=1e9, step=0.01)
            self._radius = self._gui.add_number('Radius [m]', 0.1, min=1e-3, max=1e6, step=0.001)
            self._duration = self._gui.add_number(
                'Duration [s]', 0.1, min=1e-3, max=1e6, step=0.001)
        self._handles = self._gui.add_checkbox('Handles to drag pins', True)

    def _button(self, label: str, action: Callable[[], Any]) -> None:
        self._gui.add_button(label).on_click(
            lambda event: self._answer(event.client, action))

    def _when_set(self, handle: Any, action: Callable[[Any], Any]) -> None:
        def act(event: viser.GuiEvent[Any]) -> None:
            # What the view itself has set comes from no page.
            if event.client is not None:
                self._answer(event.client, lambda: action(handle.value))
        handle.on_update(act)


def _value(number: viser.GuiNumberHandle[float]) -> float:
    # While something is typed, a page sends numbers outside the range as well.
    return float(np.clip(number.value, number.min, number.max))


def _legend() -> str:
    cells = ''.join(
        f'<div style="flex:1;height:0.8em;background:rgb({red},{green},{blue})"></div>'
        for red, green, blue in band_colors())
    return (
        f'<div style="display:flex;margin:0 1em">{cells}</div><div style="display:flex;'
        'justify-content:space-between;margin:0 1em 0.5em;font-size:0.8em">'
        '<span>no strain</span><span>that and more</span></div>')
