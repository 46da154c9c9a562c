# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether a scene keeps its energy as it moves, in any mode, at one dt."""

from collections.abc import Mapping
from contextlib import closing
import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.stable.probe_outcome import ProbeOutcome
from cloth_sim_ros.study.stable.probe_outcome import REFUSED
from cloth_sim_ros.study.stable.probe_outcome import STABLE
from cloth_sim_ros.study.stable.probe_outcome import UNSTABLE

# Of the most kinetic and elastic energy: gained from nothing, more than the scheme's own error.
MOST_GAIN = 0.1
_LOOKS = 25


def moving_probe(
        values: Mapping[str, Any], dt: float, *, seconds: float, most_steps: int = 10**9,
        check_stability: bool = True, context: Context | None = None) -> ProbeOutcome:
    """
    Run the scene of ``values`` with ``dt`` [s] and keep the books of its energy.

    It is unstable when it stops at the last finite state, or gains more than a tenth of its most
    kinetic and elastic energy from nothing. The growth is that share.

    :param seconds: simulated, and at least one step
    :param most_steps: after which the run ends in any case
    :param check_stability: False takes a dt that would be refused
    """
    scene = Scene({**values, 'dt': dt})
    steps = max(1, min(most_steps, math.ceil(seconds / dt - 1e-9)))
    try:
        run = Simulation(scene, context=context, check_stability=check_stability)
    except ClothSimError as error:
        return ProbeOutcome(REFUSED, detail=str(error))
    with closing(run):
        account = EnergyAccount(run)
        looks = min(steps, _LOOKS)
        try:
            for look in range(looks):
                account.step((look + 1) * steps // looks - look * steps // looks)
                if not account.gained <= MOST_GAIN:
                    break
        except NonFiniteStateError as error:
            return ProbeOutcome(UNSTABLE, math.inf, run.substeps, str(error))
        stable = account.gained <= MOST_GAIN
        return ProbeOutcome(STABLE if stable else UNSTABLE, account.gained, run.substeps)
