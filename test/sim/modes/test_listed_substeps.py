# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Substeps that are made by recorded calls are those that are put together each time."""

from contextlib import ExitStack

from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.held.held_impulses import HeldImpulses
from cloth_sim_ros.sim.limits.active_limits import ActiveLimits
from cloth_sim_ros.sim.limits.limit_program import Limits
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.listed_substeps import ListedSubsteps
from cloth_sim_ros.sim.modes.mass_spring import OnePass
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import start_state
from cloth_sim_ros.sim.stop import never
import numpy as np
import pytest
from springs import SPRINGS

LENGTH, LIMIT, COUNT = 0.001, 0.02, 70


def run(context, side, *, records, by_calls):
    """Return positions, velocities, pin impulses and tally after COUNT substeps."""
    scene = Scene({
        **SPRINGS, 'mode': 'adaptive', 'rows': side, 'cols': side, 'adaptive.threshold': LIMIT,
        'pins': ['top_left', 'top_right']})
    layout = choose_layout(scene, context)
    with ExitStack() as stack:
        made = []
        for make in (
                lambda: start_state(scene, layout), lambda: OnePass(scene, layout),
                lambda: ActiveLimits(scene, layout, are_many=False),
                lambda: HeldImpulses(scene, layout)):
            made.append(make())
            stack.callback(made[-1].delete)
        state, springs, limits, impulses = made
        loads = Loads(scene, layout, state)
        stack.callback(loads.delete)
        # Stretched to its limit at once, and swinging.
        state.write(state.read_positions() * (1.0 + LIMIT), state.read_velocities())
        state.impulses = impulses
        if records:
            impulses.begin_step(state.pinned, (), {}, {})
        limits.begin_step()
        substep = Limits(LENGTH, LIMIT)
        forcing = loads.forcing(state, 0.0, LENGTH)
        if by_calls:
            alike, left = ListedSubsteps(springs, limits), COUNT
            assert alike.can_make(state, forcing, substep)
            while left:
                left -= alike.make(state, forcing, substep, min(left, 8), never)
        else:
            for _ in range(COUNT):
                springs.run(state, forcing, LENGTH, acts=False)
                limits.act(state, substep, None, springs.held_at)
                state.swap()
        held = None
        if records:
            impulses.end_step({})
            held = impulses.of_last_step()
        return state.read_positions(), state.read_velocities(), held, limits.tally_of_step()


# A cloth of more than 64 x 64 nodes lists its edges in a pass of its own.
@pytest.mark.parametrize('side', [12, 66])
@pytest.mark.parametrize('records', [False, True], ids=['alone', 'pins'])
def test_recorded_calls_make_the_same_bits(context, side, records):
    """A substep would read another pair of buffers, or look for edges at other times."""
    one, other = (
        run(context, side, records=records, by_calls=by_calls) for by_calls in (False, True))
    for first, second in zip(one[:2], other[:2]):
        np.testing.assert_array_equal(first, second)
    assert one[3] == other[3]
    assert one[3].substeps == COUNT and one[3].most_active > 0
    if records:
        np.testing.assert_array_equal(one[2].changes, other[2].changes)
