# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What layers that touch cost: a towel on a floor, with self-contact and without, in turns."""

from contextlib import ExitStack
from dataclasses import asdict
from dataclasses import dataclass
import statistics
from time import process_time
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

POSES = ('flat', 'folded')
# Step of each mode [s]: implicit steps are made to be long.
STEPS = {'mass_spring': 0.001, 'adaptive': 0.001, 'constraint': 0.005}
# Side of the towel [m], its thickness over that of a cell [1]; chosen.
_SIDE = 0.6
_THICKNESS = 0.25


@dataclass(frozen=True)
class LayersSpeed:
    """
    Processor time of one towel in one mode.

    :param nodes: along each side
    :param dt: [s]
    :param without: processor time of a simulated second in each round, without self-contact [s]
    :param touching: the same with self-contact [s]
    :param contacts: of layers, after the last round
    """

    nodes: int
    pose: str
    mode: str
    dt: float
    device: str
    without: list[float]
    touching: list[float]
    contacts: int

    @property
    def ratios(self) -> list[float]:
        """Return the time with self-contact over that without, round by round."""
        return [with_it / alone for with_it, alone in zip(self.touching, self.without)]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {**asdict(self), 'ratios': self.ratios}

    def in_words(self) -> str:
        """Return a line for people."""
        return (
            f'{self.nodes} x {self.nodes}, {self.pose}, {self.mode}, steps of '
            f'{1e3 * self.dt:g} ms: {statistics.median(self.without):.2f} s of a processor for a '
            f'simulated second, {statistics.median(self.touching):.2f} s with self-contact, '
            f'{statistics.median(self.ratios):.2f} x ({min(self.ratios):.2f} to '
            f'{max(self.ratios):.2f}); {self.contacts} contacts')


def measure_layers(
        pose: str, mode: str, nodes: int, *, settle: float, seconds: float,
        rounds: int) -> LayersSpeed:
    """
    Simulate a towel on a floor with self-contact and without, a step of each in turn.

    :param pose: one of POSES
    :param nodes: along each side
    :param settle: simulated time before the first round [s]
    :param seconds: simulated time of a round [s], one step at least
    """
    dt = STEPS[mode]
    times: tuple[list[float], list[float]] = ([], [])
    with ExitStack() as stack:
        runs = [
            stack.enter_context(Simulation(towel(mode, nodes, is_enabled=is_enabled)))
            for is_enabled in (False, True)]
        for run in runs:
            if pose == 'folded':
                positions = folded(nodes)
                run.set_state(positions, np.zeros_like(positions))
            run.advance(settle)
            run.step(1)
            run.finish()
        count = max(1, round(seconds / dt))
        for _ in range(rounds):
            taken = [0.0, 0.0]
            # In turns: lists are made in some steps only, and a busy machine is slow for a while.
            for _ in range(count):
                for number, run in enumerate(runs):
                    begin = process_time()
                    run.step(1)
                    run.finish()
                    taken[number] += process_time() - begin
            for measured, time in zip(times, taken):
                measured.append(time / (count * dt))
        return LayersSpeed(
            nodes, pose, mode, dt, runs[1].device, *times, runs[1].snapshot().self_contacts)


def folded(nodes: int) -> np.ndarray:
    """Return a towel that is folded in half, on the floor, (nodes, nodes, 3) [m]."""
    cell = _SIDE / (nodes - 1)
    row, col = np.indices((nodes, nodes))
    along = row * cell - _SIDE / 2.0
    radius = cell / 2.0
    arc = np.pi * radius / 2.0
    x = np.where(np.abs(along) < arc, radius * np.cos(along / radius), arc - np.abs(along))
    z = np.where(
        np.abs(along) < arc, radius * np.sin(along / radius), np.sign(along) * radius)
    rough = 1e-4 * cell * np.random.default_rng(1).standard_normal((nodes, nodes, 3))
    found = np.stack([x, col * cell, z], axis=-1) + rough
    found[..., 2] += 0.5 * _THICKNESS * cell - found[..., 2].min()
    return found


def towel(mode: str, nodes: int, *, is_enabled: bool, dt: float | None = None) -> Scene:
    """
    Return a towel on a floor.

    :param is_enabled: whether it can touch itself
    :param dt: [s]; that of STEPS by default
    """
    thickness = _THICKNESS * _SIDE / (nodes - 1)
    return Scene({
        'mode': mode, 'rows': nodes, 'cols': nodes, 'width': _SIDE, 'height': _SIDE,
        'pins': ['none'], 'areal_density': 0.2, 'dt': dt or STEPS[mode], 'start.z': 0.0,
        'stiffness.structural': 500.0, 'stiffness.shear': 150.0,
        'bending.rigidity': [2e-6, 2e-6], 'contact.thickness': thickness,
        'colliders.names': ['floor'], 'colliders.floor.shape': 'plane',
        'colliders.floor.friction': 0.5, 'self_contact.enabled': is_enabled,
        'self_contact.thickness': thickness})
