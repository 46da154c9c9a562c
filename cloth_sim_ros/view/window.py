# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page of a view."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.view.controls import Controls
from cloth_sim_ros.view.drawing import ClothDrawing
from cloth_sim_ros.view.drawing import ColliderDrawing
from cloth_sim_ros.view.drawing import draw_surroundings
from cloth_sim_ros.view.drawing import PinHandles
from cloth_sim_ros.view.push_arrows import PushArrows
from cloth_sim_ros.view.server import do_for
from cloth_sim_ros.view.server import ViewServer
from cloth_sim_ros.view.source import Moment
from cloth_sim_ros.view.source import Source
from cloth_sim_ros.view.surface import first_hit
import numpy as np
import viser


class Window:
    """
    Shows ``source`` on every page that is open, and carries out its requests.

    :param server: to be used by this window alone
    """

    def __init__(self, server: ViewServer, source: Source) -> None:
        """Build the page; ``refresh`` fills it."""
        self._server = server
        self._source = source
        self._shown: Moment | None = None
        self._drawing = ClothDrawing(server)
        self._colliders = ColliderDrawing(server)
        self._pushes = PushArrows(server)
        self._controls = Controls(server, source, self.answer)
        self._pins = PinHandles(server, source, self.answer) if source.can_act else None
        if source.can_act:
            server.scene.on_click()(self._click)

    def refresh(self) -> None:
        """Show the latest moment; to be called again and again."""
        moment = self._source.latest()
        if moment is None:
            return
        if self._shown is None:
            self._look_at(moment)
            draw_surroundings(
                self._server.scene, moment.frame.positions, moment.frame.colliders)
        is_new = self._shown is None or moment.frame is not self._shown.frame
        # First, so that a click on what a page shows means that.
        self._shown = moment
        with self._server.atomic():
            if is_new or self._controls.full_strain != self._drawing.full_strain:
                self._drawing.draw(moment.frame, self._controls.full_strain)
            self._colliders.draw(moment.frame)
            self._pushes.draw(moment.frame)
            if self._pins is not None and is_new:
                self._pins.follow(moment.frame, self._controls.shows_handles)
            self._controls.show(moment)

    def answer(self, client: viser.ClientHandle | None, action: Callable[[], Any]) -> None:
        """Do ``action``; show its error on the page that requested it."""
        do_for(self._server, client, action)

    def _click(self, event: viser.SceneClickEvent) -> None:
        self.answer(event.client, lambda: self._act_at(event))

    def _act_at(self, event: viser.SceneClickEvent) -> None:
        if self._shown is None:
            return
        surface, frame = self._drawing.surface, self._shown.frame
        hit = first_hit(
            event.ray_origin, event.ray_direction, surface.points(frame), surface.faces)
        if hit is None:
            return
        row, col = surface.node(hit.node)
        if not self._controls.click_pushes:
            change = self._source.release if frame.pinned[row, col] else self._source.hold
            change(row, col)
            return
        along = np.asarray(event.ray_direction) / np.linalg.norm(event.ray_direction)
        force = self._controls.push_force * along
        self._source.push(
            force.tolist(), hit.point, self._controls.push_radius, self._controls.push_duration)

    def _look_at(self, moment: Moment) -> None:
        positions = moment.frame.positions[moment.frame.present]
        low, high = positions.min(axis=0), positions.max(axis=0)
        reach = max(float(np.linalg.norm(high - low)), 1e-3)
        center = (low + high) / 2.0 - (0.0, 0.0, 0.25 * reach)
        camera = self._server.initial_camera
        camera.look_at = center
        camera.position = center + np.array((0.75, -1.1, 0.6)) * reach
        camera.near, camera.far = 1e-3 * reach, 100.0 * reach
