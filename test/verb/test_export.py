# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Writing the cloth of a recording as a mesh from the command line."""

from pathlib import Path
import shutil

from cloth_sim_ros import Recording
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.verb.main import main
import numpy as np
import pytest
import trimesh

EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'
SIDE = 16


@pytest.fixture(scope='module')
def copied(tmp_path_factory):
    """Return a copy of the recording of the README, and a bag without frames."""
    folder = tmp_path_factory.mktemp('bags')
    shutil.copytree(EXAMPLE, folder / 'example')
    Recorder(folder, 'empty', 'cloth_sim').close()
    return folder


@pytest.fixture
def bags(copied, monkeypatch):
    """Stand in the folder of the recordings, and remove what comes to it."""
    before = set(copied.rglob('*'))
    monkeypatch.chdir(copied)
    yield copied
    for path in set(copied.rglob('*')) - before:
        path.unlink()


@pytest.mark.parametrize(('time', 'number'), [(None, -1), (0.0, 0), (1.26, 25), (2.9, -1)])
def test_the_frame_asked_for_is_written(bags, capsys, time, number):
    """A mesh would be of another moment of the run."""
    at = () if time is None else ('--at', str(time))
    assert main(['export', 'example', *at, '--format', 'ply', '--output', 'cloth.ply']) == 0
    points = Recording('example').arrays('points')
    said, where = capsys.readouterr().out.splitlines()
    assert said == f'the cloth at {points["time"][number]:.9g} s: 256 vertices, 450 triangles'
    assert where == 'cloth.ply'
    found = trimesh.load('cloth.ply', process=False)
    np.testing.assert_array_equal(found.vertices, points['positions'][number].reshape(-1, 3))
    np.testing.assert_allclose(
        found.vertex_normals, points['normals'][number].reshape(-1, 3), atol=1e-6)
    assert len(found.faces) == 2 * (SIDE - 1)**2
    sides = (found.face_normals[:, None] * found.vertex_normals[found.faces]).sum(axis=-1)
    assert (sides > 0.0).all()


@pytest.mark.parametrize(('source', 'kind', 'name'), [
    ('example', 'obj', 'example_1.25s.obj'), ('example', 'ply', 'example_1.25s.ply'),
    ('example', 'gltf', 'example_1.25s.glb'), ('example', 'usda', 'example_1.25s.usda'),
    ('example/../example', 'usda', 'example_1.25s.usda'),
    ('example/example_0.mcap', 'usda', 'example/example_0_1.25s.usda')])
def test_a_mesh_is_beside_its_recording(bags, capsys, source, kind, name):
    """A user would look for the file, or meshes of several times would have one name."""
    assert main(['export', source, '--at', '1.25', '--format', kind]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(bags / name)
    assert (bags / name).stat().st_size > 1000


@pytest.mark.parametrize('arguments', [
    ('--output', 'cloth.GLB'), ('--format', 'gltf', '--out', 'cloth.gltf')])
def test_the_ending_chooses_the_format(bags, arguments):
    """A user would have to say twice what kind of file it is."""
    assert main(['export', 'example', *arguments]) == 0
    assert (Path(arguments[-1]).read_bytes()[:4] == b'glTF') == arguments[-1].endswith('GLB')


@pytest.mark.parametrize(('arguments', 'complaint'), [
    (['example', '--at', '5', '--format', 'obj'],
     'example has frames from 0 to 2.9 s, and none at 5 s: give a time between them'),
    (['example', '--at', '-1', '--format', 'obj'], 'and none at -1 s: give a time between them'),
    (['example'], 'a mesh needs a format: give --format obj, ply, gltf or usda, or --output'),
    (['example', '--output', 'x.stl'], 'got x.stl: give it one of these endings'),
    (['example', '--format', 'gltf', '--output', 'x.obj'],
     'a file of --format gltf must end in .glb or .gltf, and --output in .obj: give one'),
    (['example', '--format', 'obj', '--output', 'none/x.obj'],
     'none/x.obj cannot be written (No such file or directory): give another --output'),
    (['example', '--output', 'example/metadata.yaml'], 'got metadata.yaml: give it one'),
    (['example', '--format', 'obj', '--node', 'other'], 'no frame of the node /other: name the'),
    (['empty', '--format', 'obj'], 'contains no messages: give'),
    (['none', '--format', 'obj'], 'there is no recording none: give'),
    (['.', '--format', 'obj'], 'holds no mcap and no db3 file: give the folder of a recording'),
    (['example/metadata.yaml', '--format', 'obj'], 'is neither an .mcap nor a .db3 file: give')])
def test_says_what_is_wrong(bags, capsys, arguments, complaint):
    """A mistake would end in a traceback, or a mesh of something else."""
    before = sorted(bags.rglob('*'))
    assert main(['export', *arguments]) == 1
    said = capsys.readouterr().err
    assert complaint in said and said.count('\n') == 1 and said.startswith('cloth_sim export: ')
    assert sorted(bags.rglob('*')) == before


@pytest.mark.parametrize('arguments', [
    ('--at', 'soon'), ('--at', 'nan'), ('--at', '0,1'), ('--at', ''), ('--format', 'stl')])
def test_refuses_arguments_that_are_none(bags, capsys, arguments):
    """A mistyped time or format would be taken for another one."""
    before = sorted(bags.rglob('*'))
    with pytest.raises(SystemExit) as stop:
        main(['export', 'example', '--format', 'obj', *arguments])
    assert stop.value.code == 2
    said = capsys.readouterr().err
    assert 'write it as in 1.5' in said or "invalid choice: 'stl'" in said
    assert sorted(bags.rglob('*')) == before


@pytest.mark.parametrize('output', [(), ('--output', 'example_2.9s.obj')])
def test_a_file_is_not_overwritten(bags, capsys, output):
    """A mesh that somebody works on would be lost."""
    (bags / 'example_2.9s.obj').write_text('mine')
    assert main(['export', 'example', '--format', 'obj', *output]) == 1
    assert 'already exists, and no mesh is overwritten: give another --output' in (
        capsys.readouterr().err)
    assert (bags / 'example_2.9s.obj').read_text() == 'mine'
