# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Forces of the cloth on what holds and touches it: means over a step of dt, or over a frame."""

from collections.abc import Sequence
from dataclasses import dataclass
from dataclasses import replace
from typing import Any

from cloth_sim_ros.sim.contact.contacts import ContactForce
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.held.grasps import GraspForce
from cloth_sim_ros.sim.held.held_impulses import HoldsNodes
from cloth_sim_ros.sim.held.held_impulses import Impulses
from cloth_sim_ros.sim.held.held_impulses import Node
from cloth_sim_ros.sim.held.pin_forces import PinForces
import numpy as np


def forces_at(
        impulses: Impulses | None, nodes: np.ndarray, node_mass: float,
        seconds: float) -> PinForces:
    """
    Return the force of the cloth on what holds each of ``nodes``, (n, 2) int, 0 where none was.

    :param impulses: over ``seconds`` [s]
    """
    forces, peaks = np.zeros((2, len(nodes), 3))
    if impulses is not None and len(nodes):
        slots = impulses.holders.slots
        places = np.array([slots.get(node, -1) for node in map(tuple, nodes.tolist())])
        known = places >= 0
        forces[known] = node_mass / seconds * impulses.changes[places[known]]
        peaks[known] = node_mass * impulses.peaks[places[known]]
    return PinForces(nodes, forces, peaks)


def grasp_forces(
        impulses: Impulses | None, grasps: Sequence[Grasp], positions: np.ndarray,
        node_mass: float, seconds: float) -> tuple[GraspForce, ...]:
    """
    Return the force of the cloth on each of ``grasps``, and its torque; 0 before it has held.

    :param impulses: over ``seconds`` [s]
    :param positions: now, which the arms of the torque are taken at, (rows, cols, 3) [m]
    """
    placed = {} if impulses is None else {
        grasp.name: (at, begin, end) for at, (grasp, begin, end)
        in enumerate(impulses.holders.grasps, len(impulses.holders.nodes))
        if any(grasp.nodes is present.nodes for present in grasps)}
    found = []
    for grasp in grasps:
        if impulses is None or grasp.name not in placed:
            found.append(GraspForce(grasp.name, np.zeros(3), np.zeros(3), np.zeros(3)))
            continue
        at, begin, end = placed[grasp.name]
        forces = node_mass / seconds * impulses.changes[begin:end]
        arms = positions[tuple(grasp.nodes.T)].astype(float) - np.array(grasp.pose.position)
        found.append(GraspForce(
            grasp.name, forces.sum(axis=0), np.cross(arms, forces).sum(axis=0),
            node_mass * impulses.peaks[at]))
    return tuple(found)


@dataclass(frozen=True)
class FrameForces:
    """
    Forces of the cloth on what holds and touches it, means over a frame.

    :param seconds: how long the frame was [s]
    :param pins: on each pin that held a node in it; those of grasps are left out
    :param grasps: on each grasp that held nodes in it
    :param contacts: on each collider
    """

    seconds: float
    pins: PinForces
    grasps: tuple[GraspForce, ...]
    contacts: tuple[ContactForce, ...]


class _Sum:
    """Changes of velocity, and the strongest rate of one."""

    def __init__(self) -> None:
        self.change = np.zeros(3)
        self.peak = np.zeros(3)

    def add(self, change: np.ndarray, peak: np.ndarray) -> None:
        self.change = self.change + change
        if peak @ peak > self.peak @ self.peak:
            self.peak = peak


class ForceWindow:
    """
    Adds up what holds and touches the cloth since it was opened, or asked last.

    Several can be open at once. Get one by Simulation.open_force_window.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.clear()

    def clear(self) -> None:
        """Begin a frame now."""
        self.steps = 0
        # Forces returned last, until a step is made.
        self.latest: FrameForces | None = None
        self._impulses: list[Impulses] = []
        self._contacts: list[tuple[ContactForce, ...]] = []

    def add(self, impulses: Impulses) -> None:
        """Add the impulses on holders over some steps of dt."""
        self._impulses.append(impulses)

    def add_contacts(self, contacts: tuple[ContactForce, ...]) -> None:
        """Add the forces on colliders over one step of dt."""
        self._contacts.append(contacts)

    def keep(self) -> Any:
        """Return what ``restore`` needs to come back to this moment."""
        return self.steps, self.latest, list(self._impulses), list(self._contacts)

    def restore(self, kept: Any) -> None:
        """Go back to the moment of ``keep``."""
        self.steps, self.latest, impulses, contacts = kept
        self._impulses, self._contacts = list(impulses), list(contacts)

    def contacts(self, now: tuple[ContactForce, ...]) -> tuple[ContactForce, ...]:
        """Return the means of the forces on colliders, which touch as ``now``."""
        if not self._contacts:
            return now
        share = 1.0 / max(self.steps, 1)
        return tuple(
            replace(
                last, force=share * np.sum([step[at].force for step in self._contacts], axis=0),
                torque=share * np.sum([step[at].torque for step in self._contacts], axis=0))
            for at, last in enumerate(now))

    def pins(self, node_mass: float, seconds: float) -> PinForces:
        """Return the means over ``seconds`` of the forces on pins that are of no grasp."""
        if len(self._impulses) == 1:
            impulses = self._impulses[0]
            nodes = impulses.holders.nodes[:impulses.holders.pins]
            return forces_at(impulses, nodes, node_mass, seconds)
        sums: dict[Node, _Sum] = {}
        for impulses in self._impulses:
            held = impulses.holders.nodes[:impulses.holders.pins].tolist()
            for node, change, peak in zip(
                    map(tuple, held), impulses.changes, impulses.peaks):
                sums.setdefault(node, _Sum()).add(change, peak)
        held_nodes = sorted(sums)
        changes, peaks = (
            np.array([getattr(sums[node], name) for node in held_nodes]).reshape(-1, 3)
            for name in ('change', 'peak'))
        return PinForces(
            np.array(held_nodes, dtype=int).reshape(-1, 2), node_mass / seconds * changes,
            node_mass * peaks)

    def grasps(
            self, present: Sequence[Grasp], positions: np.ndarray, node_mass: float,
            seconds: float) -> tuple[GraspForce, ...]:
        """Return the means over ``seconds`` of the forces on grasps, by their nodes now."""
        # One that was released holds its nodes where its frame was when it held them last.
        grasps: dict[int, HoldsNodes] = {}
        totals: dict[int, list[np.ndarray]] = {}
        peaks: dict[int, _Sum] = {}
        for impulses in self._impulses:
            holders = impulses.holders
            for at, (grasp, begin, end) in enumerate(holders.grasps, len(holders.nodes)):
                key = id(grasp.nodes)
                grasps[key] = grasp
                totals.setdefault(key, []).append(impulses.changes[begin:end])
                peaks.setdefault(key, _Sum()).add(np.zeros(3), impulses.peaks[at])
        for grasp in present:
            grasps[id(grasp.nodes)] = grasp
        found = []
        for key, grasp in grasps.items():
            assert isinstance(grasp, Grasp)
            none = [np.zeros((len(grasp.nodes), 3))]
            forces = node_mass / seconds * np.sum(totals.get(key, none), axis=0)
            arms = positions[tuple(grasp.nodes.T)].astype(float) - np.array(grasp.pose.position)
            found.append(GraspForce(
                grasp.name, forces.sum(axis=0), np.cross(arms, forces).sum(axis=0),
                node_mass * peaks[key].peak if key in peaks else np.zeros(3)))
        return tuple(found)


class ForceWindows:
    """The windows that are open, which go back with the steps they have counted."""

    def __init__(self) -> None:
        """Have none."""
        self.open: list[ForceWindow] = []
        # Whether the forces on colliders in the last step are in them, or in none.
        self.has_contacts = True

    def add(self, impulses: Impulses | None) -> None:
        """Add the impulses on holders to all windows."""
        if impulses is not None:
            for window in self.open:
                window.add(impulses)

    def add_contacts(self, contacts: tuple[ContactForce, ...]) -> None:
        """Add the forces on colliders in the last step of dt, if they are not in yet."""
        if not self.has_contacts:
            for window in self.open:
                window.add_contacts(contacts)
            self.has_contacts = True

    def count(self, steps: int) -> None:
        """Count ``steps`` of dt that were made."""
        for window in self.open:
            window.steps += steps
        self.has_contacts = not self.open

    def clear(self) -> None:
        """Begin the frames of all windows now."""
        for window in self.open:
            window.clear()
        self.has_contacts = True

    def keep(self) -> Any:
        """Return what ``restore`` needs to come back to this moment."""
        return self.has_contacts, [(window, window.keep()) for window in self.open]

    def restore(self, kept: Any) -> None:
        """Go back to the moment of ``keep``."""
        self.has_contacts, windows = kept
        for window, its_own in windows:
            window.restore(its_own)
