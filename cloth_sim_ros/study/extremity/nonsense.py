# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run must never tell: numbers that cannot be, or a message that helps nobody."""

from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.extremity.extreme import Extreme
import numpy as np

# Of the most kinetic and elastic energy: gained from nothing.
MOST_GAIN = 0.1
# Of hard edges, and of edges at a limit, over the limit (docs/explanation/adaptive.md).
_MOST_HARD_STRAIN = 0.05
_MOST_OVER_LIMIT = 1.5
_NORMAL_ERROR = 1e-4
# Of the distance fallen: what float32 and the solver leave of it.
_FALL_ERROR = 1e-2
# What a way out begins with.
WAYS_OUT = ('set ', 'take ', 'push ', 'stretch ', 'give ', 'use ', 'go on ')


def message_nonsense(message: str) -> tuple[str, ...]:
    """Return what is wrong with an error: it has rule, value and way out, in one line."""
    rule, *others = message.split(': ')
    wrong = []
    if not any(character.isdigit() for character in message):
        wrong.append('its message has no value')
    if not rule or not any(other.startswith(WAYS_OUT) for other in others):
        wrong.append('its message has no way out')
    if '\n' in message:
        wrong.append('its message has several lines')
    return tuple(wrong)


def nonsense_of(
        run: Simulation, seen: Snapshot, extreme: Extreme,
        account: EnergyAccount | None = None) -> tuple[str, ...]:
    """
    Return what is wrong with ``seen``, the end of ``run``.

    :param account: of its energy; None for a run that has stopped
    """
    wrong = _wrong_numbers(run, seen)
    if account is None or wrong:
        return tuple(wrong)
    if not account.gained <= MOST_GAIN and not tells_of(seen):
        wrong.append(f'gains {account.gained:.2g} of its energy from nothing')
    if extreme.holds_lengths:
        wrong += _wrong_lengths(run, seen)
    if not run.scene.pinned_nodes().any() and not extreme.push and not extreme.speed:
        wrong += _wrong_fall(run, seen, account.begin)
    return tuple(wrong)


def tells_of(seen: Snapshot) -> tuple[str, ...]:
    """Return what a snapshot itself tells to be wrong, as ~/diagnostics does."""
    told = []
    if seen.stability_margin > 1.0:
        told.append(f'substeps {seen.stability_margin:.2g} times as long as they should be')
    if not seen.lengths_are_held:
        told.append(f'edges off by {seen.max_strain:.2g} of their length')
    if not seen.solver_reached:
        told.append('a solve that did not reach its residual')
    return tuple(told)


def _wrong_numbers(run: Simulation, seen: Snapshot) -> list[str]:
    wrong = []
    if not seen.finite:
        wrong.append('is not finite')
    for name in ('kinetic_energy', 'elastic_energy', 'gravitational_energy', 'max_strain',
                 'positions', 'velocities', 'normals', 'strain'):
        if not np.isfinite(getattr(seen, name)).all():
            wrong.append(f'{name.replace("_", " ")} not finite')
    if not np.abs(np.linalg.norm(seen.normals, axis=-1) - 1.0).max() <= _NORMAL_ERROR:
        wrong.append('normals not of length 1')
    if seen.time != run.steps * run.dt:
        wrong.append('its time is not that of its steps')
    if not run.scene.timed_pin_moves():
        moved = np.abs(seen.velocities[run.scene.pinned_nodes()])
        if moved.size and moved.max() > 0.0:
            wrong.append('pins move')
    return wrong


def _wrong_lengths(run: Simulation, seen: Snapshot) -> list[str]:
    scene = run.scene
    model = AVAILABLE[run.mode].edge_model(scene)
    if model == 'hard':
        hard = set(scene['constraint.hard']) & set(FAMILIES[:2])
        # Strain is that of both structural and shear edges.
        if len(hard) == 2 and not tells_of(seen) and seen.max_strain > _MOST_HARD_STRAIN:
            return [f'hard edges are off by {seen.max_strain:.2g}']
    if model == 'limited' and scene['adaptive.scheme'] != 'paper':
        most = _MOST_OVER_LIMIT * scene['adaptive.threshold']
        if seen.max_strain > most and any(map(scene.models, FAMILIES[:2])):
            return [f'strain {seen.max_strain:.2g} with the limit {scene["adaptive.threshold"]:g}']
    return []


def _wrong_fall(run: Simulation, seen: Snapshot, begin: Snapshot) -> list[str]:
    """Return what is wrong with the fall of a cloth that nothing holds: x = t (t + h) g / 2."""
    gravity = np.array(run.scene['gravity'])
    moved = (seen.positions.astype(float) - begin.positions).mean(axis=(0, 1))
    substep = run.dt / run.substeps
    fallen = 0.5 * seen.time * (seen.time + substep) * gravity
    reach = np.abs(begin.positions).max()
    error = np.linalg.norm(moved - fallen)
    if error > _FALL_ERROR * np.linalg.norm(fallen) + 1e-6 * reach:
        return [f'falls {np.linalg.norm(moved):.3g} m in place of {np.linalg.norm(fallen):.3g} m']
    return []
