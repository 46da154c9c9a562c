# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mode mass_spring for a cloth whose layers touch each other."""

from typing import Any

from cloth_sim_ros.sim.contact.self_contact import SelfContact
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.layered_substeps import LayeredSubsteps
from cloth_sim_ros.sim.modes.layered_substeps import WrittenSubsteps
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import leave_if
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop


class LayeredSprings(WrittenSubsteps, MassSpring):
    """Substeps of springs, each with the contact of the cloth with itself."""

    has_memory = True

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        super().__init__(scene, layout, check_stability=check_stability)
        assert isinstance(self._passes, OnePass)  # make_passes has made it
        self._springs = self._passes
        self._layers = LayeredSubsteps(scene, layout)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._layers.begin_step()
        for number in range(self.substeps):
            leave_if(stop)
            self._layers.advance(
                state, begin + number * self._length, self._length, loads, self)

    def step_ahead(self, state: State, gravity: Forcing, most: int) -> int:
        """Return 0: each substep depends on the previous one."""
        return 0

    def kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""
        # A velocity belongs to the middle of its substep, so forces act from there to the next.
        return 0.5 * (self.last_length + length)

    def write(
            self, state: State, forcing: Forcing, loads: Loads, length: float,
            kick: float) -> None:
        """Write the state after ``length`` [s] by springs alone, as Motion.write."""
        self._springs.run(state, forcing, length, kick, acts=False)

    def end(self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Go on from a substep, as Motion.end."""
        state.swap()
        self.last_length = length

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make a substep of a scratch ``state``."""
        # First: contact.comp reads which nodes layers touch.
        self._layers.run_all_passes(state, loads, self._length, self)
        leave_if(stop)
        super().run_all_passes(state, loads, stop)

    def forget(self) -> None:
        """Drop impulses and lists of pairs: the next state is another."""
        self._layers.forget()
        self.last_length = self._length

    def report(self) -> dict[str, Any]:
        """Return the report of self-contact in the last step."""
        return self._layers.report()

    def delete(self) -> None:
        """Release the passes and their buffers."""
        super().delete()
        self._layers.delete()

    def _act_on_written(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        self._springs.act(forcing, layers)
