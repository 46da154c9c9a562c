# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mode mass_spring for a cloth whose layers touch each other."""

from typing import Any

from cloth_sim_ros.sim.contact.self_contact import SelfContact
from cloth_sim_ros.sim.contact.self_contact import SelfContactFigures
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop

# Max. cut of a node's displacement in a substep over a cell [1], above which the substep is made
# again in halves: the guard keeps layers from passing, not their energy.
_MOST_CUT = 0.02
# Overlap of layers over their thickness [1], above which contact does not count as held.
_MOST_OVERLAP = 0.5
# Max. number of times that a substep is halved [1].
_MOST_HALVINGS = 4


class LayeredSprings(MassSpring):
    """
    Substeps of springs, each with the contact of the cloth with itself.

    A substep in which displacements would be cut short by much is made again in halves.
    """

    has_memory = True

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        super().__init__(scene, layout, check_stability=check_stability)
        assert isinstance(self._passes, OnePass)  # make_passes has made it
        self._springs = self._passes
        self._layers = SelfContact(scene, layout)
        self._most_cut = _MOST_CUT * min(scene.spacing)
        self.forget()

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._figures, self._halvings = SelfContactFigures(), 0
        for number in range(self.substeps):
            leave_if(stop)
            self._advance(state, begin + number * self._length, self._length, loads, 0)
        state.were_pins_stopped = self._figures.cut_pins > 0

    def step_ahead(self, state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each substep goes by what the one before has found."""
        return 0

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a ``state`` that nobody needs."""
        super().run_all_passes(state, loads, stop)
        self._springs.run(state, loads.still, self._length, acts=False)
        self._begin_contact(loads.still, self._length)
        self._layers.run_all_passes(state)

    def forget(self) -> None:
        """Drop impulses and lists of pairs: the next state is another."""
        self._layers.forget()
        self.last_length = self._length
        self._figures, self._halvings = SelfContactFigures(), 0

    def report(self) -> dict[str, Any]:
        """Return what the contact of the cloth with itself did in the last step."""
        figures = self._figures
        overlap = max(0.0, 1.0 - figures.least_distance / self._scene['self_contact.thickness'])
        return {
            'self_contacts': figures.contacts, 'layer_overlap': overlap,
            'cut_nodes': figures.cut_nodes, 'largest_cut': figures.largest_cut,
            'halved_substeps': self._halvings,
            'surface_contact_held': (
                self._layers.crossings == 0 and figures.undivided == 0
                and overlap < _MOST_OVERLAP and figures.largest_cut <= self._most_cut)}

    def delete(self) -> None:
        """Release the passes, with what they allocated."""
        super().delete()
        self._layers.delete()

    def _advance(
            self, state: State, begin: float, length: float, loads: Loads, halvings: int) -> None:
        """Step ``state`` on by ``length`` [s], as it is or in halves."""
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        kick = 0.5 * (self.last_length + length)
        forcing = loads.forcing(state, begin, begin + length, kick)
        self._springs.run(state, forcing, length, kick, acts=False)
        self._begin_contact(forcing, length)
        self._layers.find(state, length)
        touch = forcing.touch
        may_halve = self._layers.has_pairs and halvings < _MOST_HALVINGS
        held_at = self._springs.held_at
        if touch is not None and may_halve:
            touch.begin_try()
        if not self._layers.has_pairs:
            if touch is not None:
                touch.act(held_at, on_surface=True)
        else:
            self._layers.begin(state)
            if touch is not None:
                touch.act_beside(self._layers, held_at)
            else:
                self._layers.let_act()
                self._layers.give(held_at)
            figures = self._layers.guard(state)
            if may_halve and figures.largest_cut > self._most_cut:
                self._halvings += 1
                if touch is not None:
                    touch.undo_try()
                if state.impulses is not None and state.impulses.is_recording:
                    state.impulses.drop_last()
                for half in range(2):
                    self._advance(
                        state, begin + 0.5 * half * length, 0.5 * length, loads, halvings + 1)
                return
            self._figures.add(figures)
        self.last_length = length
        state.swap()

    def _begin_contact(self, forcing: Forcing, length: float) -> None:
        if forcing.touch is not None:
            for program in self._layers.programs_with_colliders():
                forcing.touch.set_in(program, length)
