# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes of comparison.py here."""

from typing import Any

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
import numpy as np
from peers.gripped import BOX
from peers.gripped import GAP
from peers.gripped import Grip
from peers.gripped import hanging
from peers.gripped import level
from peers.gripped import NODES
from peers.gripped import PAD
from peers.gripped import pad_center
from peers.gripped import SIDE
from peers.gripped import THICKNESS
from peers.gripped import THROWN_MASS
from peers.gripped import THROWN_SIDE
from peers.gripped import THROWN_SPEED

_SHEET: dict[str, Any] = {
    'material.preset': 'none', 'pins': ['none'], 'stiffness.structural': 500.0,
    'stiffness.shear': 150.0, 'stiffness.bend': 0.0, 'bending.rigidity': [2e-6, 2e-6],
    'damping.structural': 0.05, 'contact.thickness': THICKNESS}


class Run:
    """A simulation that is advanced to a time."""

    def __init__(self, values: dict[str, Any], places: np.ndarray, speed: float) -> None:
        """Begin from ``places``, all nodes moving down at ``speed`` [m/s]."""
        self._cloth = Simulation(Scene({**_SHEET, **values}))
        velocities = np.zeros_like(places)
        velocities[..., 2] = -speed
        self._cloth.set_state(places, velocities)
        self._cloth.warm_up()

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        self._cloth.advance(end - self._cloth.time)
        self._cloth.finish()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (nodes, nodes, 3) [m]."""
        return self._cloth.positions()


class PinchedHere(Run):
    """The sheet between pads."""

    def __init__(self, grip: Grip, mode: str) -> None:
        """Compile the shaders, and lay the sheet between the pads."""
        area = SIDE**2 / NODES**2
        values: dict[str, Any] = {
            'rows': NODES, 'cols': NODES, 'width': SIDE, 'height': SIDE, 'mode': mode,
            'total_mass': grip.mass, 'dt': 0.002, 'colliders.names': ['left', 'right'],
            'contact.compression': grip.normal / area / (1.0 - GAP / THICKNESS)}
        for name, side in (('left', -1.0), ('right', 1.0)):
            values |= {
                f'colliders.{name}.shape': 'box', f'colliders.{name}.size': list(PAD),
                f'colliders.{name}.position': list(pad_center(side)),
                f'colliders.{name}.friction': grip.friction}
        super().__init__(values, hanging(), 0.0)

    def lift(self) -> float:
        """Return the vertical force of the pads on the sheet [N]."""
        return -sum(float(pad.force[2]) for pad in self._cloth.contact_forces())


class ThrownHere(Run):
    """
    The sheet that hits a box.

    Bodies here are kinematic: the box stays where it is, and the force on it is added up.
    """

    def __init__(self, nodes: int, mode: str) -> None:
        """Compile the shaders."""
        super().__init__({
            'rows': nodes, 'cols': nodes, 'width': THROWN_SIDE, 'height': THROWN_SIDE,
            'mode': mode, 'total_mass': THROWN_MASS, 'dt': 0.002, 'gravity': [0.0, 0.0, 0.0],
            'colliders.names': ['box'], 'colliders.box.shape': 'box',
            'colliders.box.size': list(BOX),
            'colliders.box.position': [0.0, 0.0, -0.5 * BOX[2]],
            'colliders.box.friction': 0.5}, level(nodes), THROWN_SPEED)
        self._given = 0.0

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s], and add up what the box is given."""
        while self._cloth.time < end - 1e-9:
            self._cloth.step()
            box, = self._cloth.contact_forces()
            self._given += float(box.force[2]) * self._cloth.dt

    def momenta(self) -> tuple[float, float]:
        """Return the vertical momentum of the sheet, and what the box has got [N s]."""
        speeds = self._cloth.velocities()[..., 2].astype(float)
        return float(self._cloth.scene.node_mass * speeds.sum()), self._given
