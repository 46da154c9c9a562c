# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps so short that what they move a node by is rounded off."""

from cloth_sim_ros import Batch
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
import numpy as np
import pytest

FREE = {'rows': 3, 'cols': 3, 'pins': ['none'], 'start.z': 1.0}
# Rounding of positions around 1 m [m].
HALF_ULP = 2.0**-24


@pytest.mark.parametrize('dt, steps', [
    (1e-6, 10000), (1e-7, 10000), pytest.param(1e-7, 100000, marks=pytest.mark.long)])
def test_short_steps_fall(simulate, within, any_mode, layout, dt, steps):
    """At z = 1 m it fell by 4.6 % too little after 10 ms at 1e-6 s, and not at all at 1e-7 s."""
    cloth = simulate({**FREE, 'mode': any_mode, 'layout': layout, 'dt': dt})
    start = cloth.positions()[..., 2].astype(float)
    cloth.step(steps)
    exact = -9.81 * cloth.time * (cloth.time + dt) / 2.0
    error = np.abs(cloth.positions()[..., 2] - start - exact).max()
    within(f'fall in {steps} steps of {dt:g} s [m]', error, 1e-4 * abs(exact) + HALF_ULP)
    speed = cloth.velocities()[..., 2] / (-9.81 * cloth.time)
    within('speed, relative', np.abs(speed - 1.0).max(), 1e-6)


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint'])
def test_short_steps_slide(simulate, within, mode):
    """Nodes that a collider holds off were put back to where the step began."""
    cloth = simulate({
        **FREE, 'mode': mode, 'dt': 1e-6, 'start.z': 0.001, 'contact.thickness': 0.002,
        'colliders.names': ['floor'], 'colliders.floor.shape': 'plane',
        'colliders.floor.friction': 0.0})
    start = cloth.positions()
    cloth.set_state(start, np.zeros_like(start) + [0.01, 0.0, 0.0])
    cloth.step(2000)
    error = np.abs(cloth.positions() - start - [2e-5, 0.0, 0.0]).max()
    assert cloth.snapshot().sliding_nodes == 9
    within('slid in 2000 steps [m]', error, HALF_ULP)


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_short_steps_repeat(simulate, mode):
    """Reset, new states and calls of any length leave nothing behind that changes bits."""
    cloth = simulate({**FREE, 'mode': mode, 'dt': 1e-6, 'pins': ['top_left']})
    start, rest = cloth.positions(), np.zeros((3, 3, 3))
    cloth.step(300)
    first = cloth.snapshot().state_sha256
    cloth.reset()
    for count in (1, 7, 292):
        cloth.step(count)
    assert cloth.snapshot().state_sha256 == first
    cloth.set_state(start, rest)
    cloth.step(300)
    assert cloth.snapshot().state_sha256 == first


def test_short_steps_of_a_batch(context):
    """Where a cloth starts decides whether its sums are compensated, in a batch as well."""
    scenes = [Scene({
        **FREE, 'mode': 'mass_spring', 'dt': 2e-5, 'width': 0.1, 'height': 0.1, 'start.z': z})
        for z in (0.0, 1.0, 0.01)]
    assert [needs_low_parts(scene) for scene in scenes] == [False, True, False]
    with Batch(scenes, context=context) as batch:
        batch.step(200)
        fallen = batch.positions()[..., 2].mean(axis=(1, 2)) - [0.0, 1.0, 0.01]
    time = 200 * 2e-5
    assert fallen == pytest.approx(-9.81 * time * (time + 2e-5) / 2.0, abs=HALF_ULP)


@pytest.mark.parametrize('values', [
    {}, {'dt': 0.001}, {'mode': 'constraint', 'dt': 0.001}, {'rows': 128, 'cols': 128}])
def test_usual_steps_do_without(values):
    """Usual scenes keep their bits and pay nothing."""
    assert not needs_low_parts(Scene(values))


def test_short_steps_of_a_batch_have_the_same_bits(context):
    """Low parts of one cloth would get into another, or be left behind by a reset."""
    scenes = [
        Scene({**FREE, 'mode': 'mass_spring', 'dt': 1e-6, 'start.z': z, 'start.jitter': 0.05})
        for z in (1.0, 3.0)]
    with Batch(scenes, context=context) as batch:
        batch.step(300)
        batch.reset([1])
        batch.step(200)
        found = batch.positions()
    for scene, positions, steps in zip(scenes, found, (500, 200)):
        with Simulation(scene, context=context) as alone:
            alone.step(steps)
            assert np.array_equal(alone.positions(), positions)
