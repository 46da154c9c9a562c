# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Run an extreme scene, and look for what is nonsense in what comes out."""

from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.extremity.extreme import Extreme
from cloth_sim_ros.study.extremity.extreme import REFUSED
from cloth_sim_ros.study.extremity.extreme import RUNS
from cloth_sim_ros.study.extremity.extreme import STOPS
from cloth_sim_ros.study.extremity.nonsense import message_nonsense
from cloth_sim_ros.study.extremity.nonsense import MOST_GAIN
from cloth_sim_ros.study.extremity.nonsense import nonsense_of
from cloth_sim_ros.study.extremity.nonsense import tells_of
from cloth_sim_ros.study.extremity.scenes import EXTREMES
from cloth_sim_ros.study.workers import process_context
import numpy as np

_SEED = 3


@dataclass(frozen=True)
class ExtremeOutcome:
    """
    What came of an extreme scene in one mode.

    :param outcome: runs, refused or stops
    :param detail: strain and energy at the end, or the reason
    :param gained: energy from nothing, over the most kinetic and elastic energy
    :param nonsense: what is wrong with it; empty where nothing is
    """

    outcome: str
    detail: str
    gained: float = 0.0
    nonsense: tuple[str, ...] = ()


def run_by_name(scene: Mapping[str, Any], *, name: str) -> dict[str, Any]:
    """Return what came of the extreme ``name`` in the mode of ``scene``, as plain values."""
    context = process_context()
    outcome = run_extreme(EXTREMES[name], scene['mode'], context)
    return {**vars(outcome), 'nonsense': list(outcome.nonsense), 'device': context.device}


def run_extreme(extreme: Extreme, mode: str, context: Context) -> ExtremeOutcome:
    """Run ``extreme`` in ``mode`` and judge it."""
    try:
        run = Simulation(Scene({
            'rows': 8, 'cols': 8, 'material.preset': 'none', **extreme.values, 'mode': mode}),
            context=context)
    except (ClothSimError, DeviceError) as error:
        return ExtremeOutcome(REFUSED, str(error), nonsense=message_nonsense(str(error)))
    with closing(run):
        try:
            account = _prepare(run, extreme)
            account.step(extreme.steps)
        except NonFiniteStateError as error:
            return ExtremeOutcome(
                STOPS, str(error), nonsense=(
                    *message_nonsense(str(error)), *nonsense_of(run, run.snapshot(), extreme)))
        except ClothSimError as error:
            return ExtremeOutcome(REFUSED, str(error), nonsense=message_nonsense(str(error)))
        seen = account.seen
        detail = (f'strain {seen.max_strain:.2g}, kinetic energy {seen.kinetic_energy:.2g} J, '
                  f'substeps {seen.substeps}')
        gained = account.gained if np.isfinite(account.gained) else 1.0
        if gained > MOST_GAIN:
            detail += f', energy from nothing {gained:.2g}'
        told = tells_of(seen)
        if told:
            detail += f'; reports {" and ".join(told)}'
        return ExtremeOutcome(
            RUNS, detail, gained, nonsense_of(run, seen, extreme, account))


def _prepare(run: Simulation, extreme: Extreme) -> EnergyAccount:
    random = np.random.default_rng(_SEED)
    if extreme.start is not None or extreme.speed:
        rest = run.scene.rest_positions()
        positions = rest if extreme.start is None else extreme.start(rest, random)
        run.set_state(
            positions, random.uniform(-extreme.speed, extreme.speed, rest.shape)
            if extreme.speed else np.zeros_like(positions))
    if extreme.push:
        run.push(**extreme.push)
    return EnergyAccount(run)
