# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Substeps in which layers of the cloth touch each other."""

from abc import ABC
from abc import abstractmethod
from typing import Any
from typing import Protocol

from cloth_sim_ros.sim.contact.self_contact import SelfContact
from cloth_sim_ros.sim.contact.self_contact import SelfContactFigures
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.state import SubstepEnds

# Max. cut of a node's displacement in a substep over a cell [1], above which the substep is made
# again in halves: the guard keeps layers from passing, not their energy.
_MOST_CUT = 0.02
# Overlap of layers over their thickness [1], above which contact does not count as held.
_MOST_OVERLAP = 0.5
# Max. number of times that a substep is halved [1].
_MOST_HALVINGS = 4


class Motion(Protocol):
    """The motion of the nodes in a substep without layers, and other contacts."""

    def kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""

    def write(
            self, state: State, forcing: Forcing, loads: Loads, length: float,
            kick: float) -> None:
        """Write the state after ``length`` [s]."""

    def ends(self, state: State) -> SubstepEnds:
        """Return the states that the present substep begins and ends with."""

    def act(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        """
        Let contacts act on the state that was written.

        :param layers: the contact of the cloth with itself; None where no layers touch
        """

    def end(self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Make the written state the present ``state``, and advance the time by ``length`` [s]."""

    def undo(self, state: State, forcing: Forcing) -> None:
        """Go back to where the substep began."""


class WrittenSubsteps(ABC):
    """What motions have in common that write a state, which becomes the present one at the end."""

    @staticmethod
    def ends(state: State) -> SubstepEnds:
        """Return the present state and the one that is written."""
        return state

    def act(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        """Apply contact with colliders and layers, as Motion.act."""
        if layers is not None and forcing.touch is not None:
            forcing.touch.begin_try()
        self._act_on_written(state, forcing, length, layers)

    @staticmethod
    def undo(state: State, forcing: Forcing) -> None:
        """Drop the impulses of colliders in the substep, as Motion.undo."""
        if forcing.touch is not None:
            forcing.touch.undo_try()

    @abstractmethod
    def _act_on_written(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        """Apply contact with colliders and layers to the written state."""


class LayeredSubsteps:
    """
    Applies self-contact in substeps, each as long as possible.

    A substep in which displacements would be cut short by much is made again in halves.
    ``contact`` is that of the cloth with itself.
    """

    contact: SelfContact

    def __init__(
            self, scene: Scene, layout: Layout, *, is_implicit: bool = False,
            may_note: bool = False) -> None:
        """Allocate; passes are compiled when they are first used."""
        self._thickness: float = scene['self_contact.thickness']
        self._most_cut = _MOST_CUT * min(scene.spacing)
        self.contact = SelfContact(
            scene, layout, is_implicit=is_implicit, may_note=may_note)
        self.forget()

    @property
    def has_pairs(self) -> bool:
        """Return whether layers may have touched in the last substep."""
        return self.contact.has_pairs

    def begin_step(self) -> None:
        """Restart the counts of ``report``."""
        self._figures, self._halvings = SelfContactFigures(), 0

    def advance(
            self, state: State, begin: float, length: float, loads: Loads,
            motion: Motion) -> None:
        """Step ``state`` on by ``length`` [s], as it is or in halves."""
        self._advance(state, begin, length, loads, motion, 0)
        state.were_pins_stopped = self._figures.cut_pins > 0

    def run_all_passes(
            self, state: State, loads: Loads, length: float, motion: Motion) -> None:
        """Make a substep of a scratch ``state``."""
        motion.write(state, loads.still, loads, length, length)
        self.begin_contact(loads.still, length)
        is_recording = state.impulses is not None and state.impulses.is_recording
        self.contact.run_all_passes(motion.ends(state), 0 if is_recording else -1)

    def begin_contact(self, forcing: Forcing, length: float) -> None:
        """Let colliders act in the rounds of a substep of ``length`` [s], where there are some."""
        touch = forcing.touch
        self.contact.let_colliders_act(
            None if touch is None else lambda program: touch.set_in(program, length))

    def forget(self) -> None:
        """Drop impulses and lists of pairs: the next state is another."""
        self.contact.forget()
        self.begin_step()

    def report(self) -> dict[str, Any]:
        """Return what layers did to each other since ``begin_step``."""
        figures = self._figures
        overlap = max(0.0, 1.0 - figures.least_distance / self._thickness)
        return {
            'self_contacts': figures.contacts, 'layer_overlap': overlap,
            'cut_nodes': figures.cut_nodes, 'largest_cut': figures.largest_cut,
            'halved_substeps': self._halvings,
            'surface_contact_held': (
                self.contact.crossings == 0 and figures.undivided == 0
                and overlap < _MOST_OVERLAP and figures.largest_cut <= self._most_cut)}

    def delete(self) -> None:
        """Release passes and memory."""
        self.contact.delete()

    def _advance(
            self, state: State, begin: float, length: float, loads: Loads, motion: Motion,
            halvings: int) -> None:
        kick = motion.kick(length)
        forcing = loads.forcing(state, begin, begin + length, kick)
        motion.write(state, forcing, loads, length, kick)
        self.begin_contact(forcing, length)
        self.contact.find(motion.ends(state), length)
        if not self.contact.has_pairs:
            motion.act(state, forcing, length, None)
        else:
            self.contact.begin(motion.ends(state))
            motion.act(state, forcing, length, self.contact)
            figures = self.contact.guard(motion.ends(state))
            if halvings < _MOST_HALVINGS and figures.largest_cut > self._most_cut:
                self._halvings += 1
                motion.undo(state, forcing)
                if state.impulses is not None and state.impulses.is_recording:
                    state.impulses.drop_last()
                for half in range(2):
                    self._advance(
                        state, begin + 0.5 * half * length, 0.5 * length, loads, motion,
                        halvings + 1)
                return
            self._figures.add(figures)
        motion.end(state, forcing, loads, length)
