# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A pin that moves stands still where the cloth pulls at it too hard."""

import numpy as np
import pytest

LINKS, LENGTH, MASS, STIFFNESS = 8, 1.0, 0.02, 2000.0
SPEED, DT, BOUND = 0.02, 0.005, 5.0
# A chain along x that is pulled apart by both ends, without weight.
CHAIN = {
    'rows': 1, 'cols': LINKS + 1, 'width': LENGTH, 'node_mass': MASS, 'dt': DT,
    'gravity': [0.0, 0.0, 0.0], 'stiffness.structural': STIFFNESS, 'damping.structural': 1.0,
    'stiffness.bend': 0.0, 'adaptive.threshold': 0.01,
    'pins': ['top_left', 'top_right'], 'pin_moves.node': ['top_left', 'top_right'],
    'pin_moves.start': [0.0, 0.0], 'pin_moves.speed': [SPEED, SPEED],
    'pin_moves.target': [-0.6, 0.0, 1.0, 0.6, 0.0, 1.0]}
EDGE = LENGTH / LINKS
# docs/explanation/implicit_step.md: one line, so that the weight of all nodes stretches by 0.03
# of the strain of hard edges, or of the limit.
WEIGHT = (LINKS + 1) * MASS * 9.81
STIFFEST = {
    'mass_spring': STIFFNESS,
    'constraint': WEIGHT / (0.03 * 0.008 * EDGE),
    'adaptive': STIFFNESS + WEIGHT / (0.03 * 0.001 * EDGE)}


def apart(simulation):
    """Return how far the ends are apart [m]."""
    places = simulation.snapshot().positions[0]
    return float(np.linalg.norm(places[-1] - places[0]))


@pytest.mark.parametrize('mode', STIFFEST)
def test_a_taut_chain_stops_the_pins(simulate, within, mode):
    """A gripper that is to go too far would tear at the cloth with any force, and say nothing."""
    simulation = simulate({**CHAIN, 'mode': mode, 'pin.max_force': BOUND})
    stalled, most = 0, 0.0
    for _ in range(round(1.5 / DT)):
        simulation.step()
        now = simulation.snapshot(pin_forces=True)
        stalled += now.stalled_pins > 0
        most = max(most, float(np.linalg.norm(now.pin_forces.forces, axis=-1).max()))
    # Force is looked at once a dt, in which both ends go on.
    a_step = 2.0 * SPEED * DT / LINKS * STIFFEST[mode]
    # Force of the damper of a limit [N]: its stiffness times the elongation of an edge in ten
    # listed substeps (docs/explanation/adaptive.md).
    closing = 10.0 / simulation.substeps * a_step if mode == 'adaptive' else 0.0
    # Damping pulls as well, as do the nodes that are sped up, while it is pulled.
    within('force of a pin', most, BOUND + 2.0 * a_step + closing + 0.5)
    assert stalled > 100
    assert {pin.node for pin in simulation.pin_moves} == {(0, 0), (0, LINKS)}
    assert LENGTH < apart(simulation) < LENGTH + LINKS * (BOUND + 2.0 * a_step) / STIFFNESS


def test_pins_go_on_when_the_cloth_follows(simulate, within):
    """A gripper that was stopped would wait for ever, or leap to where it was to be by then."""
    simulation = simulate({
        **CHAIN, 'mode': 'mass_spring', 'pin.max_force': BOUND, 'pin_moves.speed': [0.1, 0.1]})
    simulation.advance(1.0)
    assert simulation.snapshot().stalled_pins == 2
    simulation.release(0, LINKS)
    fastest = 0.0
    for _ in range(round(2.0 / DT)):
        simulation.step()
        fastest = max(fastest, float(np.linalg.norm(simulation.snapshot().velocities[0, 0])))
    within('speed of the pin that goes on', fastest, 0.1 * (1.0 + 1e-6))
    np.testing.assert_allclose(simulation.snapshot().positions[0, 0], [-0.6, 0.0, 1.0], atol=1e-6)
    assert not simulation.pin_moves


def test_without_a_bound_nothing_is_asked(simulate):
    """A scene without the bound would pay for it, or have its pins stopped."""
    simulation = simulate({**CHAIN, 'mode': 'mass_spring'})
    simulation.advance(1.0)
    assert simulation.snapshot().stalled_pins == 0
    assert apart(simulation) == pytest.approx(LENGTH + 2.0 * SPEED * 1.0, abs=1e-6)
