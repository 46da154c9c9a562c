# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What every mode offers."""

from collections.abc import Collection
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import Stop
import numpy as np

# Max. substeps between two checks of the state: the read-back of a check waits for the device, and
# what lies between is stepped again when one fails (docs/notes/performance.md).
CHECKED_SUBSTEPS = 64


class Mode(Protocol):
    """
    A way to step the state of a scene.

    ``stability_limit`` is the longest stable substep [s], ``substep_margin`` a substep over it,
    or, in an implicit step, over the longest in which edges turn by no more than they should.
    ``strain_bound`` is the largest strain that structural and shear edges should have,
    0 for hard edges. ``is_implicit`` says that edges pull as the end of a substep asks, so that it
    has no stability limit; other modes step by symplectic Euler. ``has_memory`` says that a step
    depends on more than the state and its time.

    :param check_stability: False takes a dt above the stability limit, to study what happens
    :raises ClothSimError: when the mode can't step the scene as it asks
    """

    name: str
    is_implicit: bool
    has_memory: bool

    @property
    def substeps(self) -> int:
        """Get how many there are in a dt."""

    @property
    def last_length(self) -> float:
        """Get the length of the last substep [s]; 0 where none was."""

    @property
    def checked_substeps(self) -> int:
        """Get how many lie between two checks of the state at most."""

    @property
    def stability_limit(self) -> float:
        """Get the longest stable substep [s]."""

    @property
    def substep_margin(self) -> float:
        """Get a substep over the longest one that is stable or accurate."""

    @property
    def strain_bound(self) -> float:
        """Get the largest strain that structural and shear edges should have."""

    def __init__(self, scene: Scene, layout: Layout, *, check_stability: bool = True) -> None:
        """Compile and allocate what this mode needs and nothing else."""

    @staticmethod
    def check(scene: Scene, *, check_stability: bool = True) -> None:
        """Raise ClothSimError when the mode can't step ``scene``, before anything is compiled."""

    @staticmethod
    def edge_model(scene: Scene) -> str:
        """Return the kind of the edges of ``scene`` in this mode: springs, limited or hard."""

    @staticmethod
    def edge_families(scene: Scene) -> Collection[str]:
        """Return the families of which ``scene`` has edges in this mode."""

    def energy_law(self, state: State) -> EdgeLaw:
        """Return the law by which the edges of ``state`` store energy now."""

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """
        Step ``state`` on by one dt.

        :param begin: simulated time at which the step begins [s]
        :param loads: what accelerates the nodes besides the edges, by time
        :param stop: asked between the parts of the step
        :raises StepAbandoned: when ``stop`` has returned True; the state is left within the step
        """

    def step_ahead(self, state: State, gravity: Forcing, most: int) -> int:
        """
        Make several steps of dt at once, all under gravity alone and with pins at rest.

        :param gravity: alone, as all of them have it
        :param most: steps to make
        :return: how many were made; 0 where ``step`` has to make each
        """

    def run_all_passes(self, state: State, loads: Loads, stop: Stop = never) -> None:
        """Run each pass that a step can need on a scratch ``state``."""

    def forget(self) -> None:
        """Drop what earlier steps left: the state is another one."""

    def report(self) -> dict[str, Any]:
        """Return the Snapshot fields of solver and constraints that are not 0."""

    def limit_marks(self, state: State) -> Buffer | None:
        """
        Return which edges of ``state`` are at their limit, as limit_mark.comp does.

        None if none are. ``report`` counts those that this has found last.
        """

    def tension(
            self, positions: np.ndarray, velocities: np.ndarray,
            nodes: np.ndarray | None = None) -> np.ndarray:
        """
        Return the tension of every edge [N], (rows, cols, 6) float32 as in Snapshot.

        What depends on the state is that of the present moment; what is solved for is that of
        the last substep.

        :param positions: of the present state, (rows, cols, 3) [m]
        :param velocities: (rows, cols, 3) [m/s]
        :param nodes: (n, 2) rows and columns: the edges at these nodes are enough
        """

    def delete(self) -> None:
        """Release the buffers and programs of the mode."""
