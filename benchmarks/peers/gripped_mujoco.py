# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes of comparison.py in MuJoCo, sheets as flexes, and the capsule of its issue 3328."""

from mujoco_peer import Flex
import numpy as np
from peers.gripped import BOX
from peers.gripped import BOX_MASS
from peers.gripped import CELL
from peers.gripped import GRAVITY
from peers.gripped import Grip
from peers.gripped import hanging
from peers.gripped import level
from peers.gripped import NODES
from peers.gripped import PAD
from peers.gripped import pad_center
from peers.gripped import THICKNESS
from peers.gripped import THROWN_MASS
from peers.gripped import THROWN_SIDE
from peers.gripped import THROWN_SPEED

STEP = 0.001  # [s]
_OPTION = """
  <option timestep="{step}" solver="CG" iterations="100" tolerance="1e-8" cone="elliptic"
      impratio="{impratio}" noslip_iterations="{noslip}" gravity="0 0 {gravity}"/>
  <size memory="1G"/>
"""
_FLEX = """
    <flexcomp name="sheet" type="grid" dim="2" count="{nodes} {nodes} 1"
        spacing="{cell} {cell} {cell}" pos="0 0 0.1" mass="{mass}" radius="{radius}">
      <edge equality="true" solref="{constant} 1"/>
      <contact selfcollide="none" condim="3" friction="{friction} 0 0" solref="{constant} 1"/>
    </flexcomp>
"""


def _box(name: str, sizes: tuple[float, ...], at: tuple[float, ...], friction: float) -> str:
    half = ' '.join(f'{0.5 * size}' for size in sizes)
    return (f'<geom name="{name}" type="box" size="{half}" '
            f'pos="{" ".join(map(str, at))}" friction="{friction} 0 0" '
            f'solref="{2.0 * STEP} 1" mass="{BOX_MASS}"/>')


class Sheet(Flex):
    """A sheet that begins somewhere else than its model has it."""

    def __init__(self, model: str, places: np.ndarray, speed: float) -> None:
        """Compile the model, and move the sheet."""
        super().__init__(len(places), f'<mujoco>{model}</mujoco>')
        self._count = 3 * places[..., 0].size
        # Coordinates are displacements from where the model has the nodes.
        self._data.qpos[-self._count:] = (places - self.positions()).ravel()
        self._data.qvel[-self._count:].reshape(-1, 3)[:, 2] = -speed


class PinchedMuJoCo(Sheet):
    """The sheet between pads."""

    def __init__(self, grip: Grip, impratio: float, noslip: int) -> None:
        """Compile the model."""
        pads = ''.join(
            _box(name, PAD, pad_center(side), grip.friction)
            for name, side in (('left', -1.0), ('right', 1.0)))
        super().__init__(
            _OPTION.format(step=STEP, impratio=impratio, noslip=noslip, gravity=-GRAVITY)
            + f'<worldbody>{pads}' + _FLEX.format(
                nodes=NODES, cell=CELL, mass=grip.mass, radius=0.5 * THICKNESS,
                constant=2.0 * STEP, friction=grip.friction) + '</worldbody>', hanging(), 0.0)

    def lift(self) -> float:
        """Return the vertical force of the pads on the sheet [N]."""
        lift = 0.0
        for number in range(self._data.ncon):
            force = np.zeros(6)
            self._mujoco.mj_contactForce(self._model, self._data, number, force)
            contact = self._data.contact[number]
            pull = float(contact.frame.reshape(3, 3)[:, 2] @ force[:3])
            # From the first of a contact to the second.
            lift += pull if contact.geom[0] >= 0 else -pull
        return lift


class ThrownMuJoCo(Sheet):
    """The sheet that hits a free box."""

    def __init__(self, nodes: int) -> None:
        """Compile the model."""
        body = ('<body name="box"><freejoint/>'
                + _box('box', BOX, (0.0, 0.0, -0.5 * BOX[2]), 0.5) + '</body>')
        super().__init__(
            _OPTION.format(step=STEP, impratio=1, noslip=0, gravity=0.0)
            + f'<worldbody>{body}' + _FLEX.format(
                nodes=nodes, cell=THROWN_SIDE / (nodes - 1), mass=THROWN_MASS,
                radius=0.5 * THICKNESS, constant=2.0 * STEP, friction=0.5) + '</worldbody>',
            level(nodes), THROWN_SPEED)

    def momenta(self) -> tuple[float, float]:
        """Return the vertical momentum of the sheet, and what the box has got [N s]."""
        speeds = self._data.qvel[-self._count:].reshape(-1, 3)[:, 2]
        return (float(THROWN_MASS / len(speeds) * speeds.sum()),
                float(BOX_MASS * self._data.qvel[2]))


_CAPSULE = """
<mujoco>
  <option timestep="{step}" cone="{cone}" impratio="{impratio}" noslip_iterations="{noslip}"/>
  <worldbody>
    <body pos="-0.0239 0 0.5"><joint name="left" type="slide" axis="1 0 0" damping="50"/>
      <geom type="box" size="0.02 0.03 0.03" friction="0.7" mass="0.1"/></body>
    <body pos="0.0239 0 0.5"><joint name="right" type="slide" axis="-1 0 0" damping="50"/>
      <geom type="box" size="0.02 0.03 0.03" friction="0.7" mass="0.1"/></body>
    <body pos="0 0 0.5"><freejoint/>
      <geom type="capsule" size="0.004 0.02" euler="90 0 0" friction="0.7" mass="0.045"/></body>
  </worldbody>
  <actuator>
    <position joint="left" kp="6000" ctrlrange="-0.1 0.1"/>
    <position joint="right" kp="6000" ctrlrange="-0.1 0.1"/>
  </actuator>
</mujoco>
"""


class Capsule:
    """A rigid capsule of 45 g between two pads of mu 0.7 that press with 12 N."""

    def __init__(self, cone: str, impratio: float, noslip: int) -> None:
        """Compile the model."""
        import mujoco
        self._mujoco = mujoco
        self._model = mujoco.MjModel.from_xml_string(_CAPSULE.format(
            step=STEP, cone=cone, impratio=impratio, noslip=noslip))
        self._data = mujoco.MjData(self._model)
        self._data.ctrl[:] = 0.002

    def advance(self, end: float) -> None:
        """Simulate up to ``end`` [s]."""
        while self._data.time < end - 1e-9:
            self._mujoco.mj_step(self._model, self._data)

    def positions(self) -> np.ndarray:
        """Return where the capsule is, (1, 1, 3) [m]."""
        return self._data.qpos[2:5].reshape(1, 1, 3).copy()

    def lift(self) -> None:
        """Return None: forces are compared of sheets."""
