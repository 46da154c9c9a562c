# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Everything that acts on nodes besides the edges: gravity, pushes, air and colliders."""

from collections.abc import Sequence
from functools import partial
import math
from typing import Any

from cloth_sim_ros.sim.contact.contacts import Contacts
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.loads.air import Air
from cloth_sim_ros.sim.loads.air import AirWork
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.push_field import PushField
from cloth_sim_ros.sim.model.wind import checked_wind
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np


class Loads:
    """
    The loads of a run, composed into what passes read with applied_acceleration.glsl.

    Modes and watchers ask here what acts, and until when it stays so; none knows which loads
    there are. ``pushes``, ``air`` and ``contacts`` are for those who add to them; ``air`` and
    ``contacts`` are None where the scene has none.

    :param state: that they act on
    """

    def __init__(self, scene: Scene, layout: Layout, state: State) -> None:
        """Begin with gravity and air alone."""
        self._make_pushes = partial(
            PushField, layout, (scene.node_mass, scene.node_shares), scene['gravity'],
            state.read_positions, state.pinned, state.buffer)
        self._masses = scene.node_mass, scene.node_shares
        self._state = state
        self.pushes = self._make_pushes()
        self.air = Air(scene, layout) if scene.has_air else None
        self.contacts = Contacts(scene, layout) if scene.has_contact else None

    @property
    def still(self) -> Forcing:
        """Return gravity alone, and the colliders as the run begins."""
        still = self.pushes.still
        return still if self.contacts is None else self.contacts.join(still, 0.0, 0.0)

    def begin_run(self) -> None:
        """Go back to gravity and the air of the scene."""
        self.pushes.delete()
        self.pushes = self._make_pushes()
        if self.air is not None:
            self.air.begin_run()
        if self.contacts is not None:
            self.contacts.begin_run()

    def begin_step(self, begin: float, end: float) -> None:
        """Begin a step of dt from ``begin`` to ``end`` [s]."""
        if self.air is not None:
            self.air.begin_step(end)
        if self.contacts is not None:
            self.contacts.begin_step()

    def forcing(
            self, state: State, begin: float, end: float, kick: float | None = None) -> Forcing:
        """
        Return the accelerations of a substep from ``begin`` to ``end`` [s]; begin its pushes.

        Asked again for the same substep, it returns the same, wherever the nodes have got to.

        :param state: as the substep begins
        :param kick: how long they act in it [s], if not for all of it; pushes keep their impulse
        """
        if self.air is None:
            forcing = self.pushes.forcing(begin, end, kick)
        else:
            forcing = self.air.forcing(state, self.pushes, begin, end, kick)
        return forcing if self.contacts is None else self.contacts.join(forcing, begin, end)

    def foreseen(self, state: State, begin: float, end: float, *, is_quiet: bool) -> Forcing:
        """
        Return what ``forcing`` would, for looking further ahead than ``end`` [s].

        :param is_quiet: whether nothing changes until then, so that no push can begin
        """
        if is_quiet and self.air is None:
            still = self.pushes.still
            return still if self.contacts is None else self.contacts.join(still, begin, end)
        return self.forcing(state, begin, end)

    def acting(self, now: float) -> Forcing:
        """Return gravity and pushes at the moment ``now`` [s], for looking: nothing begins."""
        return self.pushes.acting(now)

    def at_nodes(self, nodes: np.ndarray) -> np.ndarray:
        """
        Return how gravity and air accelerate ``nodes``, pinned ones too [m/s2], (n, 3).

        The air is that of the last substep.

        :param nodes: rows and columns, (n, 2) int
        """
        gravity = np.broadcast_to(np.array(self.still.everywhere), (len(nodes), 3))
        return gravity if self.air is None else gravity + self.air.at_nodes(nodes)

    def air_margin(self, state: State, begin: float, end: float, length: float) -> float:
        """
        Return a substep of ``length`` [s] over the longest in which air acts with all its force.

        0 without air, and where there is no doubt.

        :param begin: of the time whose wind counts [s]
        :param end: of that time [s]
        """
        return 0.0 if self.air is None else self.air.margin(state, begin, end, length)

    def keep_account(self) -> None:
        """Start adding up the work that ``work`` returns."""
        if self.air is not None:
            self.air.work = AirWork(*self._masses)

    def work(self) -> float:
        """Return the work on free nodes of all loads but gravity and pushes, until now [J]."""
        if self.air is None:
            return 0.0
        assert self.air.work is not None  # keep_account comes first
        return self.air.work.settle(self._state)

    def forget(self) -> None:
        """Drop what was kept of the state of earlier steps."""
        if self.air is not None:
            self.air.begin_step(-math.inf)
        if self.contacts is not None:
            self.contacts.forget()

    def quiet_until(self, now: float) -> float:
        """Return until when what acts at ``now`` [s] stays so: ``now`` itself, or infinite."""
        quiet = self.quiet_without_bodies_until(now)
        return quiet if self.contacts is None else min(quiet, self.contacts.quiet_until(now))

    def quiet_without_bodies_until(self, now: float) -> float:
        """Return the same of what acts besides colliders."""
        parts = (self.pushes, self.air)
        return min(part.quiet_until(now) for part in parts if part is not None)

    def still_until(self, now: float) -> float:
        """Return until when gravity alone acts: ``now`` [s] itself where more does."""
        is_alone = self.air is None and self.contacts is None
        return self.quiet_until(now) if is_alone else now

    def speed_gained(self, begin: float, end: float) -> float:
        """Return by how much loads other than gravity make a node faster at most [m/s]."""
        pushed = self.pushes.speed_gained(begin, end)
        return pushed if self.air is None else pushed + self.air.wind.fastest

    @property
    def wind(self) -> tuple[float, float, float] | None:
        """Return the steady wind [m/s]; None where there is no air."""
        return None if self.air is None else self.air.wind.steady

    def checked_wind(self, velocity: Sequence[float]) -> tuple[float, float, float]:
        """Return ``velocity`` [m/s], or raise ClothSimError where it can't blow."""
        if self.air is None:
            raise ClothSimError(
                'there is no wind in a scene without air: start it with air.density above 0, '
                '1.225 kg/m3 at sea level')
        return checked_wind(velocity)

    def set_wind(self, velocity: tuple[float, float, float]) -> None:
        """Let ``velocity``, which was checked, blow instead of the steady wind."""
        assert self.air is not None  # checked_wind has refused it otherwise
        self.air.wind.steady = velocity

    def keep(self) -> tuple[Any, ...]:
        """Return what ``restore`` needs to come back to this moment."""
        parts = (self.pushes, self.air, self.contacts)
        return tuple(None if part is None else part.keep() for part in parts)

    def restore(self, kept: tuple[Any, ...]) -> None:
        """Go back to the moment of ``keep``."""
        pushes, air, record = kept
        self.pushes.restore(pushes)
        if self.air is not None:
            self.air.restore(air)
        if self.contacts is not None:
            self.contacts.restore(record)

    def delete(self) -> None:
        """Release everything."""
        self.pushes.delete()
        for part in (self.air, self.contacts):
            if part is not None:
                part.delete()
