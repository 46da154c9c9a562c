# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mode adaptive for a cloth whose layers touch each other."""

from typing import Any

from cloth_sim_ros.sim.contact.self_contact import SelfContact
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.adaptive import Adaptive
from cloth_sim_ros.sim.modes.layered_substeps import LayeredSubsteps
from cloth_sim_ros.sim.modes.layered_substeps import WrittenSubsteps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop


class LayeredAdaptive(WrittenSubsteps, Adaptive):
    """
    Substeps of springs and of edges at their limit, each with the contact of layers.

    Layers act after limits, which find in the next substep what layers stretched. The whole cloth
    is never solved for: its substeps are longer than what the contact of layers holds.
    """

    may_solve_whole = False

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Choose the substeps and compile the passes."""
        self._layers = LayeredSubsteps(scene, layout, may_note=True)
        # Whether edges are held in the present substep.
        self._holds_edges = False
        super().__init__(scene, layout, check_stability=check_stability)

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when dt is too long, or the whole cloth would be solved for."""
        if scene['adaptive.scheme'] == 'whole':
            raise ClothSimError(
                'adaptive.scheme whole has substeps in which layers pass, and '
                'self_contact.enabled is true: set adaptive.scheme: constraint, or '
                'self_contact.enabled: false')
        Adaptive.check(scene, check_stability=check_stability)

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        self._layers.begin_step()
        super().step(state, begin, loads, stop)

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Make substeps of all kinds of a scratch ``state``."""
        self._layers.run_all_passes(state, loads, self._length, self)
        super().run_all_passes(state, loads, stop)

    def forget(self) -> None:
        """Hold no edge, and drop impulses and lists of pairs."""
        super().forget()
        self._layers.forget()

    def report(self) -> dict[str, Any]:
        """Return how edges were held in the last step, and what layers did to each other."""
        return {**super().report(), **self._layers.report()}

    def delete(self) -> None:
        """Release everything."""
        super().delete()
        self._layers.delete()

    def kick(self, length: float) -> float:
        """Return for how long [s] forces act in a substep of ``length`` [s]."""
        return self._kick(length)

    def write(
            self, state: State, forcing: Forcing, loads: Loads, length: float,
            kick: float) -> None:
        """Write the state after ``length`` [s] by springs and limits, as Motion.write."""
        if self._holds_edges:
            self._write_listed(state, forcing, loads, length)
        else:
            self._springs.run(state, forcing, length, kick, acts=False)

    def end(self, state: State, forcing: Forcing, loads: Loads, length: float) -> None:
        """Go on from a substep, as Motion.end."""
        state.swap()
        if self._holds_edges:
            self._end_listed(state, forcing, loads, length)
        else:
            self.last_length = length

    def _act_on_written(
            self, state: State, forcing: Forcing, length: float,
            layers: SelfContact | None) -> None:
        if self._holds_edges:
            self._act_on_touch(state, forcing, length, layers)
        else:
            self._springs.act(forcing, layers)

    # What Adaptive makes in a substep.

    def _can_be_calm(self) -> bool:
        """Return whether edges can be foreseen: not while layers touch."""
        return not self._layers.has_pairs

    def _make_calm(self, state: State, start: float, length: float, loads: Loads) -> None:
        self._holds_edges = False
        self._layers.advance(state, start, length, loads, self)

    def _make_alike(
            self, state: State, start: float, length: float, most: int, loads: Loads,
            stop: Stop) -> int:
        """Return 0: each substep depends on the previous one."""
        return 0

    def _make_listed(self, state: State, start: float, length: float, loads: Loads) -> None:
        self._holds_edges = True
        self._layers.advance(state, start, length, loads, self)
