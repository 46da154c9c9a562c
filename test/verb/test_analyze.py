# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Analysing recordings from the command line."""

import csv
from dataclasses import replace
import json
from pathlib import Path
import random
import shutil

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.analysis.frame_table import COLUMNS
from cloth_sim_ros.analysis.frame_table import STATS
from cloth_sim_ros.analysis.plots import run_plots
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import Summary
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.verb.main import main
from copied_bag import copy_bag
from foreign_bag import made
from foreign_bag import write_bag
from made_cloud import make_cloud
from matplotlib.image import imread
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import PointCloud2
from sensor_msgs.msg import PointField
from std_msgs.msg import Header
from std_msgs.msg import String

ROOT = Path(__file__).resolve().parents[2]
G = 9.81


def record(folder, name, seconds, *changes):
    """Record ``seconds`` of the shipped scene with ``changes`` and return the bag."""
    arguments = [part for change in (f'recording.name={name}', *changes)
                 for part in ('--set', change)]
    assert main([
        'run', str(ROOT / 'config' / 'studies' / 'two_corners.yaml'), '--seconds', str(seconds),
        '--record', str(folder), *arguments]) == 0
    return folder / name


@pytest.fixture
def analyze(tmp_path):
    """Return a function from a bag to the columns of its CSV and what its JSON holds."""

    def read(bag):
        out = tmp_path / f'{bag.name} analysed'
        assert main(['analyze', str(bag), '--out', str(out)]) == 0
        folder, = out.iterdir()
        with open(folder / 'frames.csv', newline='', encoding='utf-8') as file:
            rows = list(csv.DictReader(file))
        columns = {
            name: [row[name] for row in rows] if name == 'mode' else
            np.array([float(row[name] or 'nan') for row in rows]) for name in rows[0]}
        return columns, json.loads((folder / 'summary.json').read_text())

    return read


@pytest.fixture(scope='module')
def swinging(tmp_path_factory):
    """Return a bag of several chunks: half a second with a push."""
    return record(
        tmp_path_factory.mktemp('swinging'), 'swinging', 0.5, 'rows=32', 'cols=32',
        'publish.rate=100.0',
        'stiffness.structural=20.0', 'stiffness.shear=20.0', 'stiffness.bend=1.0',
        'pushes.start=[0.1]', 'pushes.duration=[0.2]', 'pushes.force=[0.0, 1.0, 1.5]',
        'pushes.center=[0.0, 0.0, 0.0]', 'pushes.radius=[0.0]')


def test_free_fall_is_as_in_the_textbook(tmp_path, analyze):
    """Energies or heights would be of another run, in other units, or at other times."""
    dt, mass, start = 0.005, 0.2, 1.0
    columns, summary = analyze(record(
        tmp_path, 'fall', 0.5, 'rows=7', 'cols=6', 'pins=[none]', f'dt={dt}',
        'auto_substeps=false', 'areal_density=0.2', 'publish.rate=50.0', 'start.jitter=0.0',
        'stiffness.structural=10.0', 'stiffness.shear=10.0', 'stiffness.bend=1.0'))
    steps = np.arange(0, 101, 4)
    np.testing.assert_allclose(columns['time'], steps * dt, atol=1e-9)
    # Symplectic Euler falls as the first sum over steps does.
    height = start - G * dt**2 * steps * (steps + 1) / 2
    speed = G * dt * steps
    np.testing.assert_allclose(columns['mean_height'], height, atol=1e-5)
    np.testing.assert_allclose(columns['gravitational_energy'], mass * G * height, rtol=1e-4)
    np.testing.assert_allclose(
        columns['kinetic_energy'], mass * speed**2 / 2, rtol=1e-4, atol=1e-7)
    # The step's own error: it falls by g t dt / 2 more than a stone does.
    lost = mass * G**2 * dt * columns['time'] / 2
    np.testing.assert_allclose(columns['total_energy'], mass * G * start - lost, rtol=1e-4)
    # Positions near 1 m have steps of 6e-8, a spring has 0.17 m.
    assert np.all(columns['max_strain'] < 5e-6)
    assert np.all(columns['mean_strain'] <= columns['max_strain'])
    assert (summary['rows'], summary['cols'], summary['frames']) == (7, 6, 26)
    assert summary['finite'] and summary['is_whole'] and summary['gaps'] == []


def test_a_hanging_strip_has_the_strain_of_its_weight(tmp_path, analyze):
    """Strains or the elastic energy would be of other springs, or of another moment."""
    nodes, mass, stiffness, rest = 5, 0.01, 50.0, 0.25
    columns, summary = analyze(record(
        tmp_path, 'strip', 8.0, f'rows={nodes}', 'cols=1', 'height=1.0', 'pins=[top_left]',
        f'node_mass={mass}', 'start.pose=hanging', 'start.z=-0.5',
        f'stiffness.structural={stiffness}', 'stiffness.bend=0.0', 'damping.structural=0.6',
        'damping.bend=0.0', 'dt=0.001', 'auto_substeps=false', 'publish.rate=5.0',
        'start.jitter=0.0'))
    tension = mass * G * np.arange(nodes - 1, 0, -1)
    strain = tension / (stiffness * rest)
    # The spring above a node carries more than the one below it.
    of_nodes = np.concatenate([strain[:1], strain])
    assert columns['max_strain'][-1] == pytest.approx(strain[0], rel=1e-4)
    assert columns['mean_strain'][-1] == pytest.approx(of_nodes.mean(), rel=1e-4)
    assert columns['elastic_energy'][-1] == pytest.approx(
        np.sum(tension**2) / (2 * stiffness), rel=1e-3)
    # The pin carries all: its own node as well.
    weight = nodes * mass * G
    for name in ('pin_force_z', 'pin_0_0_force_z'):
        assert columns[name][-1] == pytest.approx(-weight, rel=1e-4)
    assert columns['largest_pin_force'][-1] == pytest.approx(weight, rel=1e-4)
    heights = -np.concatenate([[0.0], np.cumsum(rest * (1.0 + strain))])
    assert columns['mean_height'][-1] == pytest.approx(heights.mean(), rel=1e-4)
    assert columns['kinetic_energy'][-1] == pytest.approx(0.0, abs=1e-9)
    assert summary['last_strain'] == pytest.approx(strain[0], rel=1e-4)
    histogram = summary['strain_histogram']
    shares = np.histogram(of_nodes, histogram['edges'])[0] / nodes
    np.testing.assert_allclose(histogram['last_frame'], shares)
    assert sum(histogram['all_frames']) == pytest.approx(1.0)


def test_what_was_done_to_the_cloth_is_told(swinging, analyze, tmp_path, capsys):
    """A reader of the report would not know what the cloth answers to."""
    columns, summary = analyze(swinging)
    push, = summary['pushes_given']
    assert (push['start'], push['duration'], push['force']) == (0.1, 0.2, [0.0, 1.0, 1.5])
    assert summary['modes'] == ['mass_spring'] and set(columns['mode']) == {'mass_spring'}
    assert summary['device'] and summary['dt'] == 0.005
    shown = capsys.readouterr().out
    for told in ('32 x 32 nodes', 'pushes: 1,', 'state              finite'):
        assert told in shown
    plots = {path.stem: imread(path) for path in tmp_path.rglob('*.png')}
    assert set(plots) == {'energies', 'strain', 'pin_forces', 'pace', 'strain_histogram'}
    assert all(plot.shape[1] > 800 for plot in plots.values())


@pytest.mark.parametrize('storage, split', [('mcap', 3), ('sqlite3', 1)])
def test_a_bag_of_ros2_bag_gives_the_same_figures(swinging, tmp_path, storage, split):
    """A run would look different when it was recorded from its topics."""
    own, copied = (Run(Recording(bag)) for bag in (
        swinging, copy_bag(swinging, tmp_path / 'copied', storage, split=split)))
    for name in own.columns:
        np.testing.assert_array_equal(own.columns[name], copied.columns[name])
    assert Summary.of(copied) == replace(Summary.of(own), name='copied')
    assert copied.pushes == own.pushes


@pytest.mark.parametrize('topics, has, missing', [
    ({'points'}, {'max_strain', 'mean_strain', 'mean_height'}, ['stats', 'state', 'inputs/mode']),
    ({'stats', 'state'}, set(STATS), ['points', 'inputs/mode'])])
def test_what_was_recorded_is_enough(swinging, tmp_path, capsys, topics, has, missing):
    """A bag with a part of the topics would be refused, or its gaps not reported."""
    bag = copy_bag(
        swinging, tmp_path / 'part', topics={f'/cloth_sim/{key}' for key in topics})
    whole, part = Run(Recording(swinging)), Run(Recording(bag))
    assert {name for name in COLUMNS[2:] if part.has(name)} == has
    for name in has:
        np.testing.assert_allclose(part.columns[name], whole.columns[name], rtol=1e-6)
    assert len(list(run_plots(part))) == (2 if 'points' in topics else 3)
    assert f'not recorded       {", ".join(missing)}' in outcome(bag, capsys)


def test_another_node_is_found_or_named(swinging, tmp_path, capsys):
    """A bag of a node with another name, or of two, could not be analysed."""
    renamed = {f'/cloth_sim/{key}': f'/left/cloth/{key}' for key in ('points', 'stats')}
    assert main(['analyze', str(copy_bag(swinging, tmp_path / 'a', renamed=renamed))]) == 1
    assert 'several nodes (/cloth_sim, /left/cloth): name one with --node' in (
        capsys.readouterr().err)
    assert main(['analyze', str(tmp_path / 'a'), '--node', 'left/cloth']) == 0


def outcome(path, capsys):
    """Return the report of `cloth_sim analyze`, or the one line that says why there is none."""
    code = main(['analyze', str(path)])
    shown = capsys.readouterr()
    if code == 0:
        assert 'cloth  ' in shown.out and 'state  ' in shown.out
        return shown.out
    assert code == 1
    before, _, reason = shown.err.rpartition('cloth_sim analyze: ')
    assert before.rpartition('\r')[2] == ''
    assert reason.count('\n') == 1 and len(reason) < 500
    return reason


def test_bag_truncated_at_fifty_places(swinging, tmp_path, capsys):
    """The recording of a crashed run would end in a traceback."""
    file, = swinging.glob('*.mcap')
    content = file.read_bytes()
    cut = tmp_path / 'cut.mcap'
    generator = random.Random(1)
    outcomes = []
    for size in sorted(generator.randrange(len(content)) for _ in range(50)):
        cut.write_bytes(content[:size])
        outcomes.append(outcome(cut, capsys))
    reports = [
        text for text in outcomes if 'truncated: read up to its last complete record' in text]
    assert len(reports) > 20
    assert all('give' in text for text in outcomes if text not in reports)
    # More is never read of less.
    frames = [int(text.partition(' frames')[0].rpartition(' ')[2]) for text in reports]
    assert frames == sorted(frames) and frames[0] < frames[-1]


def test_truncated_metadata_and_databases(swinging, tmp_path, capsys):
    """A bag of ros2 bag record that was killed would end in a traceback."""
    bag = shutil.copytree(swinging, tmp_path / 'bag')
    content = (swinging / 'metadata.yaml').read_bytes()
    generator = random.Random(2)
    for size in sorted(generator.randrange(len(content)) for _ in range(20)):
        (bag / 'metadata.yaml').write_bytes(content[:size])
        assert '51 frames' in outcome(bag, capsys)
    bag = copy_bag(swinging, tmp_path / 'copied', 'sqlite3')
    file, = bag.glob('*.db3')
    content = file.read_bytes()
    for size in sorted(generator.randrange(len(content)) for _ in range(20)):
        file.write_bytes(content[:size])
        assert '.recover' in outcome(bag, capsys)


def cloud(rows=2, cols=3, **changes):
    """Return a cloud of the node with ``changes``."""
    message = deserialize_message(make_cloud(rows, cols, 0)[0], PointCloud2)
    for name, value in changes.items():
        setattr(message, name, value)
    return message


SCAN = PointCloud2(
    height=1, width=2, point_step=12, row_step=24, data=bytes(24), fields=[
        PointField(name=name, offset=4 * place, datatype=7, count=1)
        for place, name in enumerate('xyz')])
NO_STAMP = made(
    'cloth_sim_interfaces/msg/ClothStats',
    f'std_msgs/Header header\n{"=" * 80}\nMSG: std_msgs/Header\nstring frame_id',
    header={'frame_id': 'world'})
FOREIGN = {
    'other topics': ([('/chatter', String(data='text'))], 'no frame of a cloth_sim node'),
    'no message': ([('/cloth_sim/stats', ClothStats)], 'bag contains no messages: give another'),
    'another cloud': ([('/scan/points', SCAN)], 'no field normal_x'),
    'two sizes': ([('/cloth_sim/points', cloud()), ('/cloth_sim/points', cloud(4, 3))],
                  '4 x 3 nodes at 0 s after clouds of 2 x 3'),
    'too short': ([('/cloth_sim/points', cloud(data=bytes(100)))], 'not have its declared length'),
    'unknown field': (
        [('/cloth_sim/points', cloud(fields=[
            PointField(name=field.name, offset=field.offset, datatype=77, count=1)
            for field in cloud().fields]))], 'has unknown fields'),
    'no points': ([('/cloth_sim/points', cloud(height=0, data=b''))], 'has no point'),
    'no stamp': ([('/cloth_sim/stats', NO_STAMP)], 'has None as its header.stamp.sec'),
}


@pytest.mark.parametrize('kind', FOREIGN)
def test_foreign_bags_give_a_reason(tmp_path, capsys, kind):
    """A bag of another program would end in a traceback, or in figures that mean nothing."""
    messages, reason = FOREIGN[kind]
    assert reason in outcome(write_bag(tmp_path / 'bag', messages), capsys)


def test_other_types_on_our_topics_are_left_out(tmp_path, capsys):
    """A stray publisher would spoil the whole recording."""
    bag = write_bag(tmp_path / 'bag', [
        ('/cloth_sim/points', String(data='text')), ('/cloth_sim/state', Header()),
        ('/cloth_sim/stats', ClothStats(total_energy=1.25))])
    shown = outcome(bag, capsys)
    assert '1.25 J at the end' in shown and 'not recorded       points, state' in shown


def test_stats_of_another_version(tmp_path, capsys):
    """A recording of last year would be lost."""
    stats = made(
        'cloth_sim_interfaces/msg/ClothStats',
        f'std_msgs/Header header\nfloat64 total_energy\nfloat64 max_strain\n{"=" * 80}\n'
        f'MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n{"=" * 80}\n'
        'MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec',
        header={'stamp': {'sec': 3, 'nanosec': 500000000}, 'frame_id': 'world'},
        total_energy=2.5, max_strain=0.125)
    shown = outcome(write_bag(tmp_path / 'bag', [('/cloth_sim/stats', stats)]), capsys)
    assert '3.5 to 3.5 s' in shown
    assert '2.5 J at the start' in shown
    assert '0.125 at the end' in shown
    assert 'stats of another version: without active_constraints' in shown


LIMITS = (
    'calm_substeps', 'listed_substeps', 'whole_substeps', 'listed_edges', 'limit_rounds',
    'limit_unreached', 'strain_over_bound')


def test_stats_from_before_limit_figures(tmp_path, capsys):
    """What an older node did not measure would count as 0: that its limit was never missed."""
    lines = message_definition('cloth_sim_interfaces/msg/ClothStats').splitlines()
    old = '\n'.join(line for line in lines if not any(name in line for name in LIMITS))
    values = {
        name: getattr(ClothStats(total_energy=2.5, active_constraints=9), name)
        for name in ClothStats.get_fields_and_field_types() if name not in (*LIMITS, 'header')}
    stats = made(
        'cloth_sim_interfaces/msg/ClothStats', old, **values,
        header={'stamp': {'sec': 3, 'nanosec': 0}, 'frame_id': 'world'})
    bag, out = write_bag(tmp_path / 'bag', [('/cloth_sim/stats', stats)]), tmp_path / 'out'
    assert main(['analyze', str(bag), '--out', str(out)]) == 0
    shown = capsys.readouterr().out
    assert f'stats of another version: without {", ".join(sorted(LIMITS))}' in shown
    assert 'at most 9 active' in shown
    header, row = (out / 'bag' / 'frames.csv').read_text(encoding='utf-8').splitlines()
    assert 'active_constraints' in header and not set(LIMITS) & set(header.split(','))
    files = {file.name for file in (out / 'bag').iterdir()}
    assert 'constraints.png' in files and 'limits.png' not in files
    summary = json.loads((out / 'bag' / 'summary.json').read_text(encoding='utf-8'))
    assert summary['strain_over_bound'] is summary['most_listed'] is None


@pytest.mark.parametrize('name, content', [
    ('none', None), ('empty.mcap', b''), ('text.mcap', b'no bag'), ('text.db3', b'no bag'),
    ('empty.db3', b''), ('notes.txt', b'no bag'), ('folder/', None)])
def test_what_is_no_bag_gives_a_reason(tmp_path, capsys, name, content):
    """A wrong path would end in a traceback."""
    path = tmp_path / name
    if name.endswith('/'):
        path.mkdir()
    elif content is not None:
        path.write_bytes(content)
    assert 'give' in outcome(path, capsys)


def test_bags_are_compared_with_the_first(tmp_path, capsys):
    """How far two runs are apart would have to be computed by hand."""
    first, other = (
        record(tmp_path, name, 0.4, 'rows=6', 'cols=5', *changes) for name, changes in {
            'first': (), 'other': ('stiffness.structural=300.0',)}.items())
    out = tmp_path / 'out'
    assert main(['analyze', str(first), str(other), str(first), '--out', str(out)]) == 0
    shown = capsys.readouterr().out
    assert 'first_2 with first' in shown
    assert 'all positions are bitwise identical' in shown
    far, same = json.loads((out / 'comparison.json').read_text())
    assert same['identical'] and same['matched_frames'] == 21
    assert far['rms_distance_at_most'] > 1e-3 and not far['identical']
    for name in ('comparison', 'curves'):
        assert imread(out / f'{name}.png').shape[1] > 800
    with open(out / 'other_against_first.csv', newline='', encoding='utf-8') as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 21 and float(rows[-1]['rms_distance']) == pytest.approx(
        far['rms_distance_at_end'])


def test_all_frames_are_exported(swinging, tmp_path, capsys):
    """Positions over time would have to be taken out of the recording by hand."""
    out = tmp_path / 'out'
    assert main(['analyze', str(swinging), '--out', str(out), '--npz']) == 0
    exported = np.load(out / swinging.name / 'points.npz')
    points = Recording(swinging).arrays('points')
    assert set(exported) == set(points) and exported['positions'].shape == (51, 32, 32, 3)
    for name in points:
        np.testing.assert_array_equal(exported[name], points[name])
    assert main(['analyze', str(swinging), '--npz']) == 1
    assert '--npz needs a folder for its files: give --out' in capsys.readouterr().err


def test_cloths_of_other_sizes_are_not_compared(tmp_path, capsys):
    """Nodes would be compared with others than their own."""
    bags = [str(record(tmp_path, f'bag{rows}', 0.1, f'rows={rows}', 'cols=4')) for rows in (4, 5)]
    assert main(['analyze', *bags]) == 1
    assert 'has 4 x 4 nodes and ' in capsys.readouterr().err


def test_an_out_that_cannot_be_is_told_first(swinging, tmp_path, capsys):
    """Minutes of reading would be lost to a wrong path."""
    (tmp_path / 'file').write_text('')
    assert main(['analyze', str(swinging), '--out', str(tmp_path / 'file')]) == 1
    shown = capsys.readouterr()
    assert 'give another --out' in shown.err and '32 x 32' not in shown.out
