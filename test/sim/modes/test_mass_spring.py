# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How many substeps mode mass_spring submits at once, which its bits do not depend on."""

from collections.abc import Callable
from collections.abc import Iterator

from abandoned import calls_of
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.modes import mass_spring
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS

# Twice as many nodes as software is given at once for 64 substeps.
_SCENE = {
    **SPRINGS, 'rows': 64, 'cols': 128, 'dt': 0.02, 'auto_substeps': True,
    'stiffness.structural': 1000.0}


@pytest.fixture
def simulate() -> Iterator[Callable[..., Simulation]]:
    """Return a function that makes a cloth on a device that counts as software, or does not."""
    context = Context(single_thread=True)
    opened = []

    def make(*, is_software: bool) -> Simulation:
        context.is_software = is_software
        opened.append(Simulation(Scene(_SCENE), context=context, tuned=False))
        return opened[-1]

    yield make
    for simulation in opened:
        simulation.close()
    context.close()


def test_a_device_beside_the_host_is_given_more_at_once(simulate):
    """It would be idle while the host sends a frame, having been given a moment's work."""
    software, beside = simulate(is_software=True), simulate(is_software=False)
    assert beside.layout.is_asynchronous and not software.layout.is_asynchronous
    assert software.substeps == beside.substeps > 64
    assert calls_of(beside, steps=2) < calls_of(software, steps=2)


def test_the_bits_are_those_of_single_substeps(simulate, monkeypatch: pytest.MonkeyPatch):
    """A run would depend on how busy the device is."""
    at_once = simulate(is_software=False)
    monkeypatch.setattr(mass_spring, '_SUBMITTED_AT_ONCE', 1)
    singly = simulate(is_software=False)
    assert calls_of(at_once, steps=2) < calls_of(singly, steps=2)
    assert at_once.snapshot().state_sha256 == singly.snapshot().state_sha256
