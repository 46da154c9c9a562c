# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth that swings: what its pins give is what its momentum gets."""

import numpy as np

# A step so short that no mode splits it: forces are told of the end of a step.
SWINGING = {'rows': 9, 'cols': 7, 'pins': ['top_left', 'top_right', '4,3'], 'dt': 1e-4}


def swinging(simulate, values):
    """Return a cloth that has fallen for a while, in longer steps than it goes on with."""
    fallen = simulate({**SWINGING, **values, 'dt': 1e-3})
    fallen.advance(0.15)
    state = fallen.snapshot()
    simulation = simulate({**SWINGING, **values})
    simulation.set_state(state.positions, state.velocities)
    simulation.step(50)
    return simulation


def test_pins_give_what_the_momentum_gets(simulate, within, force_scene):
    """A robot would feel another force than the cloth does."""
    check_momentum(swinging(simulate, force_scene), within)


def test_pins_that_move_give_what_the_momentum_gets(simulate, within, force_scene):
    """A robot would not feel that it sets its node in motion."""
    simulation = swinging(simulate, force_scene)
    positions = simulation.snapshot().positions.astype(float)
    # All at once: cloth that can't stretch leaves one of them nowhere to go.
    for row, col in np.argwhere(simulation.pinned_nodes()).tolist():
        simulation.move_pin(row, col, positions[row, col] + (1.0, 0.0, 0.0), 0.1)
    check_momentum(simulation, within)
    assert simulation.pin_moves


def check_momentum(simulation, within):
    """Step on, and hold what the pins give to what the momentum gets."""
    looks = [simulation.snapshot(pin_forces=True)]
    for _ in range(200):
        simulation.step()
        looks.append(simulation.snapshot(pin_forces=True))
    assert {look.substeps for look in looks} == {1}
    held = np.array([look.pin_forces.forces.sum(axis=0) for look in looks])
    mass = simulation.scene.node_mass
    weight = simulation.scene.node_count * mass * np.array(simulation.scene['gravity'])
    change = looks[-1].velocities.astype(float) - looks[0].velocities
    # Some forces are told of the start of a step and some of its end: the mean of both serves.
    seconds = simulation.dt * 200
    given = (held[1:] + held[:-1]).sum(axis=0) / 2.0 * simulation.dt
    got = mass * change.sum(axis=(0, 1)) - seconds * weight
    within('momentum given by the pins less that got, over the weight times the time',
           np.abs(given - got).max() / np.abs(seconds * weight).max(), 0.01)
