# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Each input that there is, as somebody gives it, and a cloth that all of them can act on."""

from collections.abc import Callable

from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import SetWind
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.simulation import Simulation
from springs import SPRINGS

# A cloth with pins, air and a collider, in which ``handle`` grasps and pushes.
HANDLED = {
    **SPRINGS, 'rows': 7, 'cols': 9, 'dt': 0.004, 'air.density': 1.2, 'air.drag': 1.0,
    'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.1],
    'colliders.ball.position': [0.0, 0.0, 0.5]}
_TURN = (0.6, 0.0, 0.0, 0.8)


def handle(simulation: Simulation) -> None:
    """Bring a cloth of HANDLED to where each of GIVEN has something to act on."""
    simulation.grasp('hand', simulation.positions()[6, 4].astype(float))
    simulation.push((0.0, 0.1, 0.0), duration=0.03)
    simulation.move_pin(0, 0, (-0.4, 0.5, 1.1), speed=0.5)
    simulation.step(3)


def _pushes(cloth: Simulation) -> list[Input]:
    return [
        PushNodes(Push.checked(
            force=(0.0, 0.0, 0.5), start=0.0, duration=0.05, region='sphere',
            center=(0.0, 0.0, 1.0), radius=0.3), starts_now=True),
        PushNodes(Push.checked(
            force=(0.1, 0.0, 0.0), start=0.05, duration=0.02, region='all',
            center=(0.0, 0.0, 0.0), radius=0.0))]


def _grasps(cloth: Simulation) -> list[Input]:
    corner, middle = cloth.positions()[[6, 3], [8, 4]].astype(float)
    return [
        TakeGrasp('one', tuple(middle)),
        TakeGrasp('many', tuple(corner), _TURN, radius=0.3, max_force=50.0),
        TakeGrasp('top', tuple(middle - (0.1, 0.0, 0.0)), count=2, layers='top'),
        TakeGrasp('given', (0.0, 0.0, 1.0), nodes=[(2, 2), (2, 1)])]


# The inputs of each class, for a cloth that ``handle`` has handled.
GIVEN: dict[type, Callable[[Simulation], list[Input]]] = {
    PushNodes: _pushes,
    ClearPushes: lambda cloth: [ClearPushes()],
    Pin: lambda cloth: [Pin(4, 4), Pin(0, 0)],
    Unpin: lambda cloth: [Unpin(0, 0)],
    MovePin: lambda cloth: [
        MovePin(0, 8, (0.4, 0.5, 1.2)), MovePin(0, 0, (-0.5, 0.5, 1.0), 0.25)],
    TakeGrasp: _grasps,
    Release: lambda cloth: [Release('hand')],
    MoveGrasp: lambda cloth: [
        MoveGrasp('hand', (0.1, -0.5, 1.0)),
        MoveGrasp('hand', (0.1, -0.4, 1.1), _TURN, 0.5, 2.0, 0.3)],
    MoveCollider: lambda cloth: [
        MoveCollider('ball', (0.0, 0.1, 0.6), _TURN, 0.5, 2.0, 0.3),
        MoveCollider('ball', (0.0, 0.0, 0.7))],
    SetWind: lambda cloth: [SetWind((0.0, 3.0, 0.5))],
    SetMode: lambda cloth: [SetMode('constraint')],
    Reset: lambda cloth: [Reset()],
    ReplaceState: lambda cloth: [ReplaceState(cloth.positions() + 0.25, cloth.velocities())],
}
