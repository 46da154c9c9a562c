# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What pins, grasps and colliders of a running cloth feel."""

from abc import ABC
from abc import abstractmethod

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.contacts import ContactForce
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.force_window import forces_at
from cloth_sim_ros.sim.force_window import ForceWindow
from cloth_sim_ros.sim.force_window import ForceWindows
from cloth_sim_ros.sim.force_window import FrameForces
from cloth_sim_ros.sim.force_window import grasp_forces
from cloth_sim_ros.sim.grasps import GraspForce
from cloth_sim_ros.sim.grasps import Grasps
from cloth_sim_ros.sim.held_impulses import HeldImpulses
from cloth_sim_ros.sim.held_impulses import Impulses
from cloth_sim_ros.sim.pin_forces import PinForces
from cloth_sim_ros.sim.pin_motion import PinMotion
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation_arguments import checked_snapshot
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stepping import RunStatus
import numpy as np


class ForceReadings(RunStatus, ABC):
    """
    The forces of a Simulation, each that of the cloth on what holds or touches it.

    They are means over time, so that force times time adds up to what the momentum of the cloth
    has lost: over the last step of dt, or over a frame of several.
    """

    scene: Scene
    dt: float
    _state: State
    _impulses: HeldImpulses
    _windows: ForceWindows
    _held: Grasps
    _pin_motion: PinMotion
    _records_forces: bool
    # How many steps have been made, those too that were undone.
    _furthest: int

    @abstractmethod
    def positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32."""

    @abstractmethod
    def snapshot(self, *, tension: bool = False, pin_forces: bool = False) -> Snapshot:
        """Return the complete state at this time."""

    @abstractmethod
    def grasped_nodes(self) -> np.ndarray:
        """Return which nodes grasps hold, (rows, cols) bool."""

    @property
    def knows_forces(self) -> bool:
        """
        Tell whether the forces on pins and grasps in the last step of dt are known.

        They are recorded in the last step of each call of ``step`` and ``advance``, unless
        ``records_forces`` is False, and in all steps while a force window is open.
        """
        return self._impulses.knows_last_step or not self._state.pinned.any()

    def pin_forces(self) -> PinForces:
        """
        Return the force of the cloth on what holds each pinned node.

        It is the mean over the last step of dt, with the strongest of its substeps beside it.

        :raises ClothSimError: when that was not recorded, see ``knows_forces``
        """
        forces = self.snapshot(pin_forces=True).pin_forces
        assert forces is not None
        return forces

    def contact_forces(self) -> tuple[ContactForce, ...]:
        """
        Return the force of the cloth on each collider, in the order of ``colliders.names``.

        It is the mean over the last step of dt.
        """
        self.stepping.refuse_mid_step('contact_forces')
        contacts = self.loads.contacts
        return () if contacts is None else contacts.forces(self.positions(), self.time)

    def grasp_forces(self, snapshot: Snapshot | None = None) -> tuple[GraspForce, ...]:
        """
        Return the force of the cloth on each grasp, and its torque.

        They are the means over the last step of dt, with the strongest force of its substeps.

        :param snapshot: of this time; made here by default
        """
        self.stepping.refuse_mid_step('forces')
        positions = (
            self.positions() if snapshot is None
            else checked_snapshot(snapshot, self.time).positions)
        return grasp_forces(
            self._last_impulses(), self._held.present(self.time), positions,
            self.scene.node_mass, self.dt)

    def open_force_window(self) -> ForceWindow:
        """
        Return what adds up forces from now on, for ``frame_forces``; close it in the end.

        The forces of all frames together add up to the change of momentum, however many steps of
        dt a frame has.
        """
        self.stepping.refuse_mid_step('forces')
        self._settle_windows()
        self._windows.open.append(ForceWindow())
        self._windows.has_contacts = True
        return self._windows.open[-1]

    def close_force_window(self, window: ForceWindow) -> None:
        """Add up nothing in ``window`` any more."""
        self._check_open(window)
        self._windows.open.remove(window)

    def frame_forces(
            self, window: ForceWindow, snapshot: Snapshot | None = None) -> FrameForces:
        """
        Return the forces of the cloth, means over the steps since ``window`` was asked last.

        Where no step was made since, they are those of the last step of dt.

        :param snapshot: of this time; made here by default
        """
        self.stepping.refuse_mid_step('forces')
        self._check_open(window)
        if snapshot is not None:
            checked_snapshot(snapshot, self.time)
        if not window.steps and window.latest is not None:
            return window.latest
        snapshot = snapshot or self.snapshot(pin_forces=True)
        self._windows.add(self._impulses.take())
        present = self._held.present(self.time)
        contacts = self.contact_forces()
        if not window.steps:
            nodes = np.argwhere(self._state.pinned & ~self.grasped_nodes())
            last, mass = self._last_impulses(), self.scene.node_mass
            return FrameForces(
                self.dt, forces_at(last, nodes, mass, self.dt),
                grasp_forces(last, present, snapshot.positions, mass, self.dt), contacts)
        self._windows.add_contacts(contacts)
        seconds, mass = window.steps * self.dt, self.scene.node_mass
        found = FrameForces(
            seconds, window.pins(mass, seconds),
            window.grasps(present, snapshot.positions, mass, seconds), window.contacts(contacts))
        window.clear()
        window.latest = found
        return found

    def _last_impulses(self) -> Impulses | None:
        if not self.knows_forces:
            raise ClothSimError(
                'the forces on pins and grasps in the last step were not recorded: make the '
                'Simulation with records_forces=True and end a call of step or advance, or open '
                'a force window before the step')
        return self._impulses.of_last_step()

    def _records(self, number: int) -> bool:
        """Tell whether somebody can read the forces of the step of that ``number``."""
        if self._windows.open:
            return True
        # Steps that are made again may end at any of them.
        return self._records_forces and (
            self.stepping.is_last(number) or number < self._furthest)

    def _check_open(self, window: ForceWindow) -> None:
        if not any(window is each for each in self._windows.open):
            raise ClothSimError(
                'the window must be an open one of open_force_window, got '
                f'{shown(window)}: open one first')

    def _begin_impulses(self, begin: float, *, records: bool) -> None:
        if not records:
            # A small cloth makes a step in the time of some hundred of these lines.
            if self._impulses.knows_last_step:
                self._impulses.leave_out_step()
            return
        self._take_contacts(begin)
        self._windows.add(self._impulses.begin_step(
            self._state.pinned, self._held.present(begin), self._pin_motion.velocities,
            self._pin_motion.caught, edits=self._state.edits))

    def _end_impulses(self, number: int, steps: int) -> None:
        self._furthest = max(self._furthest, number + steps)
        pins, impulses = self._pin_motion, self._impulses
        if impulses.is_within_step or pins.velocities or impulses.velocities:
            impulses.end_step(pins.velocities)
        pins.caught.clear()
        if self._windows.open:
            self._windows.count(steps)

    def _settle_windows(self) -> None:
        self._windows.add(self._impulses.take())
        self._take_contacts(self.time)

    def _take_contacts(self, now: float) -> None:
        """Add what colliders had in the last step to the open windows, before it is gone."""
        contacts = self.loads.contacts
        if contacts is not None and not self._windows.has_contacts:
            self._windows.add_contacts(contacts.forces(self._state.read_positions(), now))
