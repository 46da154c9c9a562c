# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The same scene on the same device gives the same bits."""

from itertools import product
import json
import os
import subprocess
import sys

from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest
from springs import SPRINGS

SCENE = {
    **SPRINGS, 'rows': 37, 'cols': 23, 'dt': 0.004, 'start.jitter': 0.05,
    'pushes.start': [0.02, 0.06], 'pushes.duration': [0.04, 0.02],
    'pushes.force': [0.0, 0.0, 4.0, 1.0, 0.0, 0.0],
    'pushes.center': [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 'pushes.radius': [0.0, 0.4]}

# Its pushes take some edges to their limit and let them go again; calm enough for hard edges.
LIMITED = {
    **SCENE, 'rows': 17, 'cols': 13, 'start.jitter': 0.002, 'adaptive.threshold': 0.01}

IN_A_PROCESS = """
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import json, sys
for values, spans in json.loads(sys.argv[1]):
    simulation = Simulation(Scene(values))
    for seconds, mode in spans:
        simulation.set_mode(mode)
        simulation.push((0.0, 0.3, 0.5), start=simulation.time + 0.013, duration=0.04,
                        region='sphere', center=(0.1, 0.0, 1.0), radius=0.3)
        simulation.pin(5, 5)
        simulation.advance(seconds)
        simulation.release(5, 5)
    simulation.advance(0.1)
    print(simulation.snapshot().state_sha256)
    simulation.close()
"""


def _hashes_of_a_process(*runs, **environment):
    """
    Make some runs in a process, one after the other, and return the hash of the end of each.

    :param runs: the values of each, and its spans of seconds and mode, with pushes and pins
    """
    done = subprocess.run(
        [sys.executable, '-c', IN_A_PROCESS, json.dumps(runs)], check=True, text=True,
        capture_output=True, env={**os.environ, **environment})
    hashes = done.stdout.split()
    assert len(hashes) == len(runs)
    return hashes


@pytest.fixture(scope='session')
def hashes_of_all():
    """
    Make runs in one process, and in the opposite order in another; return their hashes.

    Once a session: tests come by their mode, those of other modules in between.
    """
    runs = {}
    for mode in modes.AVAILABLE:
        runs['plain', mode] = ({**SCENE, 'mode': mode}, ())
        runs['paper', mode] = ({**SCENE, 'mode': mode, 'layout': 'paper'}, ())
        runs['switches', mode] = ({**LIMITED, 'mode': mode}, (
            (0.12, mode), *((0.08, other) for other in (*modes.AVAILABLE, mode))))
    # A cloth of this size has no worker threads by itself; see test_threads_do_not_show.
    first = _hashes_of_a_process(*runs.values(), LP_NUM_THREADS='0')
    second = _hashes_of_a_process(*reversed(runs.values()))
    return dict(zip(runs, zip(first, reversed(second))))


@pytest.fixture
def hashes_of_two(hashes_of_all, any_mode):
    """Return the hashes of the runs that begin in one mode."""
    return {name: hashes for (name, mode), hashes in hashes_of_all.items() if mode == any_mode}


@pytest.fixture(scope='session')
def hashes_with_threads():
    """Make the plain run of each mode with two worker threads; return their hashes."""
    return dict(zip(modes.AVAILABLE, _hashes_of_a_process(
        *(({**SCENE, 'mode': mode}, ()) for mode in modes.AVAILABLE), LP_NUM_THREADS='2')))


def test_two_processes_give_one_state(hashes_of_two):
    """A run depends on thread timing, on memory nobody wrote or on the run before."""
    first, second = hashes_of_two['plain']
    assert first == second


@pytest.mark.long
@pytest.mark.parametrize('loads_and_block', [('texture', 1), ('storage', 2)])
def test_two_processes_give_one_state_by_other_ways(any_mode, loads_and_block):
    """One of these ways through the shaders depends on thread timing or on memory nobody wrote."""
    loads, block = loads_and_block
    run = ({**SCENE, 'mode': any_mode, 'loads': loads, 'block': block}, ())
    assert _hashes_of_a_process(run) == _hashes_of_a_process(run)


def test_a_tuning_changes_no_bits_on_a_software_device(context):
    """What `cloth_sim tune` finds on one machine would make other results than on the next."""
    if not context.is_software:
        pytest.skip('compilers of GPUs may contract sums otherwise in each of them')
    hashes = set()
    for loads, block in product(('texture', 'storage'), (1, 2, 4)):
        with Simulation(Scene({**SCENE, 'loads': loads, 'block': block}), context=context) as run:
            run.advance(0.1)
            hashes.add(run.snapshot().state_sha256)
    assert len(hashes) == 1


def test_paper_layout_too(hashes_of_two):
    """The paper's layout depends on thread timing or on memory nobody wrote."""
    first, second = hashes_of_two['paper']
    assert first == second


def test_switches_and_pushes_at_fixed_times_too(hashes_of_two):
    """A mode keeps something of an earlier run or reads memory nobody wrote."""
    first, second = hashes_of_two['switches']
    assert first == second


@pytest.mark.parametrize('any_mode', [
    'mass_spring', *(pytest.param(mode, marks=pytest.mark.long)
                     for mode in modes.AVAILABLE if mode != 'mass_spring')], indirect=True)
def test_the_times_of_switches_count(any_mode):
    """A switch would happen at another time than reported."""
    first, second = _hashes_of_a_process(*(
        ({**LIMITED, 'mode': any_mode},
         [(seconds, any_mode), *((0.08, other) for other in modes.AVAILABLE)])
        for seconds in (0.12, 0.2)))
    assert first != second


def test_threads_do_not_show(any_mode, hashes_of_two, hashes_with_threads):
    """The number of the driver's threads changes the result."""
    without, _ = hashes_of_two['plain']
    assert hashes_with_threads[any_mode] == without


def test_reset_starts_the_same_run(simulate, any_mode, layout):
    """Something of the run before a reset is left over."""
    simulation = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    start = simulation.snapshot().state_sha256
    simulation.advance(0.1)
    first = simulation.snapshot().state_sha256
    simulation.push((0.0, 1.0, 0.0), duration=5.0)
    simulation.pin(5, 5)
    simulation.advance(0.1)
    simulation.reset()
    assert simulation.snapshot().state_sha256 == start
    simulation.advance(0.1)
    assert simulation.snapshot().state_sha256 == first
    assert first != start


def test_reset_forgets_what_a_mode_remembers(simulate, any_mode):
    """Warm starts of the run before would be left over, of this mode or another."""
    simulation = simulate({**LIMITED, 'mode': any_mode})
    hashes = []
    for _ in range(2):
        simulation.set_mode(any_mode)
        simulation.advance(0.2)
        end = simulation.snapshot()
        hashes.append(end.state_sha256)
        assert any_mode != 'adaptive' or end.active_constraints > 0, 'there is nothing to remember'
        for other in modes.AVAILABLE:
            simulation.set_mode(other)
            simulation.advance(0.05)
        simulation.reset()
    assert hashes[0] == hashes[1]


def test_a_switch_and_back_leaves_the_state_alone(simulate, any_mode):
    """What a mode kept from before it was left would come back with it."""
    hashes = []
    for switches in (True, False):
        simulation = simulate({**LIMITED, 'mode': any_mode})
        simulation.advance(0.2)
        if switches:
            for other in (*modes.AVAILABLE, any_mode):
                simulation.set_mode(other)
        else:
            # The mode knows nothing but the state, and not how it came to it.
            now = simulation.snapshot()
            simulation.set_state(now.positions, now.velocities)
        simulation.advance(0.1)
        hashes.append(simulation.snapshot().state_sha256)
    assert hashes[0] == hashes[1]


def test_pieces_make_the_same_run(simulate, any_mode, layout):
    """Looking at the state, or advancing in pieces, changes it."""
    whole = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    whole.advance(0.1)
    pieces = simulate({**SCENE, 'mode': any_mode, 'layout': layout})
    for _ in range(5):
        pieces.advance(0.02)
        pieces.snapshot()
    assert pieces.steps == whole.steps == 25
    assert pieces.snapshot().state_sha256 == whole.snapshot().state_sha256
