# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a forked child may do with the simulation of its parent."""

import json
import os
import subprocess
import sys

import pytest

# Forks after a step; in the child, makes each call and prints what came of it.
PROGRAM = """
import json, os, sys
from cloth_sim_ros import Batch, Scene, Simulation

side = int(sys.argv[1])
scene = Scene({'rows': side, 'cols': side})
cloth, batch = Simulation(scene), Batch(scene, 1)
cloth.step()
child = os.fork()
if not child:
    found = {}
    for name, call in {
            'step': lambda: cloth.step(), 'advance': lambda: cloth.advance(0.1),
            'positions': lambda: cloth.positions(), 'snapshot': lambda: cloth.snapshot(),
            'push': lambda: cloth.push((0.0, 0.0, 1.0), duration=1.0),
            'pin': lambda: cloth.pin(1, 1), 'reset': lambda: cloth.reset(),
            'mode': lambda: cloth.set_mode('adaptive'), 'finish': lambda: cloth.finish(),
            'batch step': lambda: batch.step(), 'batch state': lambda: batch.positions(),
            'new': lambda: Simulation(scene).step(), 'close': lambda: cloth.close(),
            'batch close': lambda: batch.close()}.items():
        try:
            call()
            found[name] = ''
        except BaseException as error:
            found[name] = f'{type(error).__name__}: {error}'
    print(json.dumps(found), flush=True)
    os._exit(0)
assert os.waitpid(child, 0)[1] == 0
cloth.step(3)
print(cloth.steps, cloth.device)
"""


def run(side, environment):
    """Return what the child found, and what the parent printed afterwards."""
    without = {name: value for name, value in os.environ.items() if name != 'LP_NUM_THREADS'}
    # A child that hangs holds its parent.
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM, str(side)], env={**without, **environment},
        capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    child, parent = done.stdout.splitlines()
    return json.loads(child), parent


@pytest.mark.parametrize('side, environment', [
    (130, {'LP_NUM_THREADS': '2'}), (8, {'LP_NUM_THREADS': '0'})], ids=['threads', 'none'])
def test_a_forked_child_is_refused_at_once(side, environment):
    """A child of multiprocessing's 'fork' hung for ever in its first step."""
    found, parent = run(side, environment)
    assert parent.startswith('4 ')
    has_threads = side == 130 and 'llvmpipe' in parent
    for name, told in found.items():
        if name in ('close', 'batch close'):
            assert told == ''
        elif name == 'new':
            assert told.startswith('DeviceError: a GL context cannot') or not has_threads
        else:
            assert told.startswith('DeviceError: this GL context was created before a fork'), name
            assert 'spawn' in told


def test_forks_that_use_no_device_work():
    """A program could no longer fork once it had imported the simulation."""
    done = subprocess.run([sys.executable, '-c', """
import multiprocessing
from cloth_sim_ros import Scene, Simulation

def strain(stiffness):
    scene = Scene({'rows': 4, 'cols': 4, 'stiffness.structural': stiffness})
    with Simulation(scene) as cloth:
        cloth.advance(0.1)
        return cloth.measure().max_strain

with multiprocessing.get_context('fork').Pool(2) as pool:
    print(len(pool.map(strain, [50.0, 100.0, 200.0])))
"""], capture_output=True, text=True, timeout=300)
    assert done.stdout == '3\n', done.stderr
