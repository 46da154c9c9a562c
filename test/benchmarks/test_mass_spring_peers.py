# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The peers of mode mass_spring step the same cloth; those that are not installed are skipped."""

import json
from pathlib import Path
import subprocess
import sys

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.speed import bench_scene
import mass_spring_peers
from mass_spring_peers import compare
from mass_spring_peers import deviations
from mass_spring_peers import factories
from mass_spring_peers import FUSED
from mass_spring_peers import main
from mass_spring_peers import NAMES
from mass_spring_peers import ONE_THREAD
from mass_spring_peers import TOLERANCE
import numpy as np
from peers.cloth import cloth_of
from peers.numpy_peer import NumpyCloth
import pytest

BENCHMARKS = Path(mass_spring_peers.__file__).parent
# Arguments of a short run.
QUICK = ['--sizes', '8', '9', '--rounds', '2', '--round-seconds', '0.001', '--json']


@pytest.fixture(autouse=True)
def one_thread(monkeypatch):
    """Have what main sets in the environment undone."""
    for name, value in ONE_THREAD.items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def context():
    """Return a GL context for the layouts of this simulation."""
    context = Context(single_thread=True)
    yield context
    context.close()


def peer_factory(name, context):
    """Return what makes a cloth of the peer; skip the test where it is missing."""
    made, left_out = factories([name], context)
    if name in left_out:
        pytest.skip(left_out[name])
    return made[name]


def run_main(capsys, *arguments):
    """Return the exit code and the lines of JSON."""
    code = main([*QUICK, *arguments])
    return code, [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize('name', NAMES)
@pytest.mark.parametrize('changes', [
    {},
    # The fewest nodes that have all springs; and rows longer than the strips of the C peer.
    {'rows': 3, 'cols': 3},
    {'rows': 4, 'cols': 1030},
    {'cols': 21, 'gravity': [1.0, -2.0, -9.81], 'pins': ['bottom_left'],
     'stiffness.shear': 40.0, 'stiffness.bend': 25.0, 'damping.structural': 3e-4,
     'damping.shear': 2e-4, 'damping.bend': 1e-4}], ids=['square', 'least', 'wide', 'other'])
def test_a_peer_steps_the_same_cloth(name, changes, context):
    """The speeds would be those of different work."""
    factory = peer_factory(name, context)
    scene = bench_scene(13, changes)
    reference = MassSpringReference(scene)
    reference.step(40)
    peer = factory(cloth_of(scene))
    # Odd counts: states that change places would be mixed up.
    for count in (13, 27):
        peer.step(count)
    # At rest the cloth would agree with anything.
    assert np.abs(reference.positions - scene.start_positions()).max() > 10 * TOLERANCE
    np.testing.assert_allclose(peer.positions(), reference.positions, atol=TOLERANCE)


def test_a_cloth_without_all_springs_is_refused():
    """A peer would read springs that are not there."""
    with pytest.raises(ValueError, match='at least 3 nodes along each side'):
        cloth_of(Scene({'rows': 2, 'cols': 9, 'material.preset': 'none'}))


def test_the_c_peer_leaves_denormals_to_the_process(context):
    """Once it is loaded, NumPy and the reference would flush small numbers to zero."""
    peer_factory('C, once', context)
    # A process of its own: other peers do so.
    subprocess.run([sys.executable, '-c', """
from cloth_sim_ros.study.speed import bench_scene
import numpy as np
from peers.c_peer import OnceCloth
from peers.cloth import cloth_of
OnceCloth(cloth_of(bench_scene(5, {}))).step(1)
assert np.float32(1e-40) * np.float32(0.5) > 0.0
"""], cwd=BENCHMARKS, check=True)


def test_json_says_what_was_measured_and_on_what(capsys):
    """Figures could not be compared with those of another machine or version."""
    code, (machine, *sizes) = run_main(capsys, '--only', 'NumPy', 'paper')
    assert code == 0
    assert {'device', 'driver', 'processor', 'versions', 'commit', 'environment', 'left_out',
            'deviations', 'not_timed'} <= set(machine)
    assert {'python', 'numpy', 'cloth_sim_ros', 'PyOpenGL'} <= set(machine['versions'])
    assert set(machine['deviations']) == {FUSED, 'NumPy', 'paper'}
    assert [size['nodes'] for size in sizes] == [8, 9]
    for size in sizes:
        assert [speed['peer'] for speed in size['speeds']] == [FUSED, 'NumPy', 'paper']
        fused = size['speeds'][0]
        for speed in size['speeds']:
            assert speed['median'] == np.median(speed['rounds'])
            assert speed['ratio_rounds'] == [
                here / there for here, there in zip(fused['rounds'], speed['rounds'])]
            assert speed['ratio'] == np.median(speed['ratio_rounds'])
            assert speed['processor_ratio'] > 0.0


@pytest.mark.parametrize('wrong', [
    lambda self, count: None,
    lambda self, count: self._positions.fill(np.nan)], ids=['at rest', 'not a number'])
def test_a_peer_that_is_wrong_is_named_and_not_timed(wrong, monkeypatch, capsys):
    """A peer could be fast because it does something else."""
    monkeypatch.setattr(NumpyCloth, 'step', wrong)
    code, (machine, *sizes) = run_main(capsys, '--only', 'NumPy')
    assert code == 1
    assert machine['not_timed'] == ['NumPy']
    assert machine['deviations']['NumPy'] > TOLERANCE >= machine['deviations'][FUSED]
    assert [[speed['peer'] for speed in size['speeds']] for size in sizes] == [[FUSED]] * 2


def test_a_peer_that_is_not_installed_is_named(monkeypatch, capsys):
    """Nobody would know which comparison is missing, or there would be none at all."""
    monkeypatch.setitem(mass_spring_peers.MODULES, 'NumPy', 'no_such_peer:Cloth')
    monkeypatch.setenv('CC', 'no-such-compiler')
    code, (machine, *sizes) = run_main(capsys, '--only', 'NumPy', 'C, once')
    assert code == 0
    assert 'no_such_peer' in machine['left_out']['NumPy']
    assert 'install gcc' in machine['left_out']['C, once']
    assert [[speed['peer'] for speed in size['speeds']] for size in sizes] == [[FUSED]] * 2


def test_what_is_timed_is_what_was_asked_for():
    """The speed would be that of fewer steps than it is divided by."""
    class Counted:
        def __init__(self, cloth):
            made.append(self)
            self.steps = []

        def step(self, count):
            self.steps.append(count)

    made = []
    (speeds,) = compare({FUSED: Counted}, [4], 3, 1e-6)
    (peer,) = made
    assert len(speeds.speeds[0].rounds) == 3
    assert len(set(peer.steps[-3:])) == 1


def test_deviations_are_those_of_the_worst_node(context):
    """A peer that is wrong at its border alone would pass."""
    class Shifted(NumpyCloth):
        def positions(self):
            positions = super().positions()
            positions[-1, 0, 2] += 1.0
            return positions

    assert deviations({'shifted': Shifted}, 5)['shifted'] == pytest.approx(1.0, abs=1e-3)
