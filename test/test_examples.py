# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The examples, each run as its docstring says, on less time."""

import ast
from contextlib import contextmanager
import os
from pathlib import Path
import re
import subprocess
import sys
import sysconfig

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_ros import Recording
from cloth_sim_ros import Scene
from cloth_sim_ros.node.shared_memory import VARIABLE
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.verb.main import main
from matplotlib.image import imread
from node_process import NodeProcess
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
# Max. time of an example [s]: 48 x 48 nodes fold in 210 s, and other processes slow them down.
_LONGEST = 1200.0
EXAMPLES = sorted((ROOT / 'examples').glob('*.py'))


@pytest.fixture(autouse=True)
def without_profile(monkeypatch):
    """Give nodes the shared memory that a user's have, whatever other tests have chosen."""
    monkeypatch.delenv(VARIABLE, raising=False)


@contextmanager
def running_node(folder, parameters, *arguments):
    """Give a node whose shaders are compiled: examples wait for one for a while only."""
    with NodeProcess(folder, parameters, *arguments) as node:
        node.wait_until_it_runs()
        assert node.running, node.output
        yield node


def ended(name, folder, *arguments):
    """Return how examples/NAME.py ended, run in ``folder``."""
    return subprocess.run(
        [sys.executable, str(ROOT / 'examples' / f'{name}.py'), *map(str, arguments)],
        cwd=folder, capture_output=True, text=True, timeout=_LONGEST)


def run_example(name, folder, *arguments):
    """Return what examples/NAME.py prints, run in ``folder``."""
    done = ended(name, folder, *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_each_is_short_says_how_to_run_it_and_is_run_here():
    """An example would be too long to read, or rot."""
    assert len(EXAMPLES) == 14
    tests = Path(__file__).read_text(encoding='utf-8')
    for path in EXAMPLES:
        text = path.read_text(encoding='utf-8')
        assert len(text.splitlines()) < 60, path
        assert f'python examples/{path.name}' in ast.get_docstring(ast.parse(text)), path
        assert f"'{path.stem}'" in tests or f"'{path.name}'" in tests, path


def test_the_first_cloth_falls(tmp_path):
    """The first thing that a user tries would show nothing."""
    shown = run_example('first_cloth', tmp_path, '--seconds', 0.3)
    heights = [float(line.split()[1]) for line in shown.splitlines()[1:]]
    assert len(heights) == 3 and heights == sorted(heights, reverse=True)


def test_a_towel_has_its_own_size_and_weight(tmp_path):
    """A user's own cloth would be another one."""
    shown = run_example(
        'own_towel', tmp_path, '--width', 0.4, '--height', 0.5, '--weight', 0.2, '--seconds', 0.1)
    assert '21 x 17 nodes, 0.200 kg' in shown
    towel = np.load(tmp_path / 'towel.npz')['positions']
    assert towel.shape == (21, 17, 3)
    assert np.ptp(towel[..., 0]) == pytest.approx(0.4, rel=0.05)


def test_the_mode_within_the_budget_is_chosen(tmp_path):
    """A user would be advised a mode that stretches too far."""
    shown = run_example('choose_mode', tmp_path, '--seconds', 0.2, '--budget', 0.02)
    strains = {
        mode: float(strain) for mode, strain in re.findall(r'(\w+) +largest strain +(.+)%', shown)}
    assert len(strains) == 3
    assert strains[re.search('choose (.*)', shown)[1]] <= 2.0


def test_the_force_at_a_dragged_corner_is_bounded(tmp_path):
    """A gripper would tear at the cloth, or read no force."""
    shown = run_example('drag_a_corner', tmp_path, '--speed', 2.0, '--max-force', 0.2)
    rows = [line.split() for line in shown.splitlines()[1:]]
    assert any('stands' in row for row in rows)
    assert any(np.linalg.norm([float(part) for part in row[2:5]]) > 0.01 for row in rows)


def test_a_run_is_recorded_and_made_again(tmp_path):
    """The promise of the same bits would not hold for the program that shows it."""
    shown = run_example('record_and_rerun', tmp_path, '--seconds', 0.2)
    assert '11 of 11 frames bitwise identical' in shown
    assert 'bits may differ: material.warp set to other values' in shown
    assert list((tmp_path / 'bags' / 'pushed').glob('*.mcap'))


@pytest.mark.parametrize('has_pandas', [True, False])
def test_a_recording_becomes_a_table(tmp_path, has_pandas):
    """A user's table would lack frames, or need pandas."""
    if not has_pandas:
        # As on a machine without it.
        (tmp_path / 'pandas.py').write_text('raise ImportError("no pandas here")\n')
    done = subprocess.run(
        [sys.executable, str(ROOT / 'examples' / 'analyse_recording.py'),
         str(ROOT / 'bags' / 'example'), '--csv', 'table.csv'],
        cwd=tmp_path, capture_output=True, text=True, timeout=300, check=True,
        env={'PYTHONPATH': str(tmp_path), 'PATH': '/usr/bin:/bin'})
    assert ('count' in done.stdout) == has_pandas
    assert ('largest of each column' in done.stdout) != has_pandas
    table = np.genfromtxt(tmp_path / 'table.csv', delimiter=',', names=True)
    frames = Recording(ROOT / 'bags' / 'example').arrays('stats')
    assert len(table) == len(frames['time']) and np.all(np.diff(table['time']) > 0.0)


def test_a_client_carries_a_towel(tmp_path):
    """The first robot program of a user would not get along with the node."""
    # Names of its own: other tests have nodes on the same graph.
    parameters = {'rows': 8, 'cols': 8, 'real_time_factor': 0.0, 'publish.rate': 20.0}
    with running_node(tmp_path, parameters, '-r', '__ns:=/carried'):
        shown = run_example(
            'carry_towel', tmp_path, '--node', '/carried/cloth_sim', '--by', 0.2, 0.0, 0.1,
            '--speed', 1.0)
    moved = ast.literal_eval(re.search(r'moved by (.*) m', shown)[1])
    np.testing.assert_allclose(moved, [[0.2, 0.0, 0.1]] * 2, atol=2e-3)


def test_a_client_reads_the_cloth_and_switches_the_mode(tmp_path):
    """A node of a user's own would find no topics, no positions or no service."""
    parameters = {'rows': 8, 'cols': 9, 'real_time_factor': 0.0, 'publish.rate': 20.0}
    with running_node(tmp_path, parameters, '-r', '__ns:=/watched'):
        shown = run_example(
            'watch_cloth', tmp_path, '--node', '/watched/cloth_sim', '--mode', 'constraint')
    assert '/watched/cloth_sim/points' in shown.splitlines()
    before, after = shown.split('mode constraint, was mass_spring')
    assert before.count(' lowest ') >= 5 and after.count(' lowest ') == 5


def test_a_client_picks_up_a_corner(tmp_path):
    """A robot program could not grasp, carry and feel a towel."""
    parameters = {
        **load_parameters(ROOT / 'config' / 'towel_on_floor.yaml'), 'rows': 12, 'cols': 12,
        'real_time_factor': 0.0, 'publish.rate': 20.0}
    with running_node(tmp_path, parameters, '-r', '__ns:=/picked'):
        shown = run_example('pick_up_a_corner', tmp_path, '--node', '/picked/cloth_sim')
    assert re.search(r'grasp hand holds \d+ nodes', shown)
    felt = [
        list(map(float, force.split())) for force in re.findall(r'the hand feels (.*) N', shown)]
    # In the axes of the hand, whose y axis points up in the end: the towel weighs 0.39 N. It
    # swings, and hangs loosely for a moment where the hand stops.
    assert len(felt) == 3 and np.all(np.linalg.norm(felt, axis=1) < 2.0), shown
    assert min(felt[1][1], felt[2][1]) < -0.1, shown
    assert 'nodes of grasp hand are free' in shown


def test_a_corner_that_a_camera_sees_is_grasped(tmp_path):
    """A planner could not go from a depth picture to the cloth."""
    given = load_parameters(ROOT / 'config' / 'towel_under_camera.yaml')
    # On the table alone, its corners are where they were at the start.
    flat = {
        **{name: value for name, value in given.items()
           if not name.startswith(('colliders.ball', 'colliders.box'))},
        'rows': 16, 'cols': 16, 'start.z': 0.01, 'colliders.names': ['table'],
        'colliders.table.color': [0.9, 0.9, 0.9]}
    with running_node(tmp_path, flat, '-r', '__ns:=/seen_corner') as node:
        shown = run_example(
            'depth_to_grasp', tmp_path, '--node', '/seen_corner/cloth_sim')
        assert node.running
    place = np.array(ast.literal_eval(re.search(r'corner at (.*) m in', shown)[1]))
    away = Scene(flat).cameras[0].pose.in_world(place)
    corners = 0.25 * np.array([(1, 1), (1, -1), (-1, 1), (-1, -1)])
    # To a finger's width: where the window is filled by three eighths.
    assert np.linalg.norm(corners - away[:2], axis=1).min() < 0.03 and abs(away[2]) < 0.01
    assert re.search(r'grasp hand holds \d+ nodes', shown), shown


@pytest.mark.parametrize('name', ['pick_up_a_corner', 'carry_towel', 'watch_cloth'])
def test_a_client_without_a_node_ends(tmp_path, name):
    """pick_up_a_corner.py waited for ever."""
    done = ended(name, tmp_path, '--node', '/nowhere/cloth_sim', '--wait', 1.0)
    assert done.returncode == 1 and 'start cloth_sim_node' in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize(('name', 'arguments', 'told'), [
    ('pick_up_a_corner', ('--at', 5.0, 5.0, 5.0), 'has no free node within'),
    ('carry_towel', ('--speed', -1.0), 'speed of a pin')])
def test_a_client_that_is_refused_ends(tmp_path, name, arguments, told):
    """pick_up_a_corner.py went on with a hand that held nothing, and waited for its force."""
    parameters = {'rows': 8, 'cols': 8, 'publish.rate': 20.0}
    with running_node(tmp_path, parameters, '-r', '__ns:=/refusing'):
        done = ended(name, tmp_path, '--node', '/refusing/cloth_sim', *arguments)
    assert done.returncode == 1 and told in done.stderr
    assert 'Traceback' not in done.stderr


def test_two_stiffnesses_share_a_plot(tmp_path):
    """A comparison would show one of them, or none."""
    shown = run_example('compare_stiffness', tmp_path, 100, 1000, '--seconds', 0.3)
    soft, stiff = (float(strain) for strain in re.findall(r'strain (.*) %', shown))
    assert soft > stiff
    assert imread(tmp_path / 'stiffness.png').shape[:2] == (660, 880)


def test_a_folded_towel_is_spread_by_what_is_learned(tmp_path):
    """The program that shows how to train would learn nothing."""
    shown = run_example('train_spread', tmp_path)
    before, after = map(float, re.search(r'by (.*) mm before, (.*) mm after', shown).groups())
    assert before > 60.0 and after < 0.4 * before, shown
    assert imread(tmp_path / 'spread.png').shape[:2] == (240, 640)


@pytest.mark.parametrize('seconds', [2.3, pytest.param(7.0, marks=pytest.mark.long)])
def test_fingers_in_tf_fold_a_towel(tmp_path, seconds):
    """A robot in tf would need a program that moves its fingers in the simulation."""
    values = load_parameters(ROOT / 'config' / 'tf_fingers.yaml')
    values |= {'recording.enabled': True, 'recording.name': 'fold'}
    values = {name: list(value) if isinstance(value, tuple) else value
              for name, value in values.items()}
    with NodeProcess(tmp_path, values):
        shown = run_example('fold_by_tf', tmp_path, seconds)
    forces = {float(time): (float(front), float(back)) for time, front, back in re.findall(
        r'(\S+) s front +(\S+) N back +(\S+) N', shown)}
    front, back = forces[1.99]
    assert front == pytest.approx(-back, rel=0.05) and back > 3.0, 'it is pinched'
    if seconds < 7.0:
        return
    assert max(map(abs, forces[6.99])) < 0.1, 'it is let go'
    clouds, times = held_cloth(tmp_path / 'bags' / 'fold')
    carried = clouds[(times > 2.1) & (times < 5.18)]
    slip = np.linalg.norm(carried - carried[0], axis=-1).max()
    print(f'slip {slip:.1e} m, forces {front:.2f} and {back:.2f} N')
    assert slip <= 1e-5, 'it does not slip'
    last = Recording(tmp_path / 'bags' / 'fold').arrays('points')['positions'][-1]
    assert last[-1, :, 1].min() > 0.05 and last[..., 2].max() < 0.05, 'its end lies on the other'


@pytest.mark.parametrize('nodes', [20, pytest.param(48, marks=pytest.mark.long)])
def test_services_fold_a_towel(tmp_path, nodes, capsys):
    """A robot could not fold by services, or a recording of it not be made again to the bit."""
    values = {
        **load_parameters(ROOT / 'config' / 'towel_to_fold.yaml'), 'rows': nodes, 'cols': nodes,
        'real_time_factor': 0.0, 'recording.enabled': True, 'recording.name': 'by_services'}
    with running_node(tmp_path, values):
        shown = run_example('fold_by_services', tmp_path)
    area, apart, speed = map(float, re.findall(r'([\d.e-]+) (?:of the area|mm)', shown))
    path = tmp_path / 'bags' / 'by_services'
    recording = Recording(path)
    clouds, stats = recording.arrays('points'), recording.arrays('stats')
    middle = clouds['positions'][-1, [0, -1], nodes // 2, 2] / values['self_contact.thickness']
    slip = max(
        off_the_frame(clouds, [entry.message for entry in recording.entries('inputs/grasp')]))
    print(f'{shown}, middles of the hems at {middle} thicknesses, held nodes off by {slip:.1e} m, '
          f'{np.median(stats["real_time_factor"]):.2g} x real time')
    cell = 1e3 * values['width'] / (nodes - 1)
    assert area == pytest.approx(0.5, abs=0.03) and apart < cell and speed < 1.0, shown
    assert stats['surface_contact_held'].all()
    np.testing.assert_allclose(middle, [1.5, 0.5], atol=0.2)
    assert slip < 1e-6
    if nodes < 48:
        return
    measured = capsys.readouterr().out
    assert main(['resimulate', str(path)]) == 0
    again = capsys.readouterr().out
    print(measured, again)
    assert re.search(r'(\d+) of \1 frames bitwise identical', again)


def off_the_frame(clouds, changes):
    """Yield how far the nodes of each grasp have moved against each other [m]."""
    times, places = clouds['time'], clouds['positions'].astype(float)
    for taken in changes:
        if not taken.grasped:
            continue
        begin, end = (
            each.header.stamp.sec + 1e-9 * each.header.stamp.nanosec for each in changes
            if each.name == taken.name)
        held = places[(times >= begin) & (times < end)][:, list(taken.rows), list(taken.cols)]
        lengths = np.linalg.norm(held - held[:, :1], axis=-1)
        yield float(np.abs(lengths - lengths[0]).max())


def held_cloth(folder):
    """Return where the pinched nodes are, seen from a finger, (frames, nodes, 3), and when [s]."""
    recording = Recording(folder)
    poses = {}
    for raw in recording.raw_messages():
        for each in recording.decode(raw).transforms if raw.topic == '/tf' else ():
            if each.child_frame_id.endswith('collider_back'):
                place, turn = each.transform.translation, each.transform.rotation
                poses[raw.time] = Pose((place.x, place.y, place.z), (
                    turn.x, turn.y, turn.z, turn.w))
    epoch = min(poses)
    clouds = recording.arrays('points')
    seen = np.array([
        poses[epoch + round(time * 1e9)].seen_from(cloud.reshape(-1, 3).astype(float))
        for time, cloud in zip(clouds['time'], clouds['positions'])])
    times = clouds['time'] + 1e-9 * epoch
    closed = seen[np.searchsorted(times, 2.1)]
    held = (np.abs(closed - (0.0, -0.0135, 0.0)) < (0.05, 0.005, 0.02)).all(axis=-1)
    assert held.sum() > 10
    return seen[:, held], times


def test_clients_in_c_plus_plus_act_on_codes(tmp_path):
    """A user of C++ would find no way in, or one that does not build."""
    source, build = ROOT / 'examples' / 'cpp_client', tmp_path / 'build'
    prefix = {'CMAKE_PREFIX_PATH': os.pathsep.join(
        [sys.prefix, *filter(None, [os.environ.get('CMAKE_PREFIX_PATH')])])}
    for command in (['cmake', '-S', str(source), '-B', str(build)],
                    ['cmake', '--build', str(build)]):
        done = subprocess.run(
            command, env={**os.environ, **prefix}, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    # ROS from wheels expects Python to be there, in whatever uses it.
    python = Path(sysconfig.get_config_var('LIBDIR'), sysconfig.get_config_var('LDLIBRARY'))

    def run(client, *arguments):
        return subprocess.run(
            [str(client), *arguments], env={**os.environ, 'LD_PRELOAD': str(python)},
            capture_output=True, text=True, timeout=300)

    # That in rclcpp is built where ROS has rclcpp.
    clients = [path for path in sorted(build.glob('*_client')) if os.access(path, os.X_OK)]
    assert build / 'cloth_client' in clients
    with running_node(tmp_path, {'rows': 4, 'cols': 4, 'start_paused': True}):
        for number, client in enumerate(clients, 1):
            done = run(client, '/cloth_sim', '5')
            assert (done.returncode, done.stdout) == (
                ResultCode.OK, f'5 steps done, now at {0.025 * number:g} s\n'), done.stderr
            done = run(client, '/cloth_sim', '0')
            assert done.returncode == ResultCode.INVALID_VALUE
            assert 'steps 0 is outside its range' in done.stdout
    with running_node(tmp_path, {'rows': 4, 'cols': 4}):
        for client in clients:
            done = run(client, '/cloth_sim', '5')
            assert done.returncode == ResultCode.WRONG_STATE
            assert 'pause it first: ros2' in done.stdout
