# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Meshes as files, opened again by other programs."""

from dataclasses import replace
import json
from pathlib import Path
import re
import resource
import sys

from cloth_sim_ros import ClothSimError
from cloth_sim_ros import write_mesh
from cloth_sim_ros.sim.mesh import mesh_of_nodes
import numpy as np
import pytest
import trimesh

ROWS, COLS = 6, 9
CUT = np.ones((ROWS - 1, COLS - 1), bool)
CUT[0, 0] = CUT[1:3, 3:6] = CUT[4, 5:] = False
WHOLE = np.ones_like(CUT)
LOADED = ('.obj', '.ply', '.glb', '.gltf')
# Max. rounding of positions [m]: OBJ has 9 decimals, the others have all bits of float32.
ROUNDING = {'.obj': 5.1e-10}
# Max. rounding of texture coordinates [1]: glTF stores 1 - v.
UV_ROUNDING = 6e-8


def wave(present):
    """Return the mesh of a cloth in waves, of cells of 0.1 m x 0.1 m seen from above."""
    x, y = np.meshgrid(0.1 * np.arange(COLS), 0.1 * np.arange(ROWS)[::-1])
    slope = 0.3 * np.cos(9.0 * x)
    positions = np.stack([x, y, np.sin(9.0 * x) / 30.0], axis=-1)
    normals = np.stack([-slope, 0.0 * x, 1.0 + 0.0 * x], axis=-1)
    normals /= np.linalg.norm(normals, axis=-1)[..., None]
    return mesh_of_nodes(positions, normals, present)


@pytest.fixture(params=[WHOLE, CUT], ids=['rectangle', 'cut'])
def mesh(request):
    """Return the mesh of a rectangle, and of a cloth with a hole and two corners cut off."""
    return wave(request.param)


def loaded(path):
    """Return what trimesh finds in a file, and how it is turned in the scene there."""
    found = trimesh.load(path, process=False)
    if isinstance(found, trimesh.Scene):
        turn, name = found.graph[found.graph.nodes_geometry[0]]
        return found.geometry[name], turn
    return found, np.eye(4)


@pytest.mark.parametrize('ending', LOADED)
def test_another_program_finds_the_same_mesh(mesh, tmp_path, ending):
    """Another program would show another cloth, its other side, or a texture upside down."""
    path = tmp_path / f'cloth{ending}'
    write_mesh(mesh, path)
    assert list(tmp_path.iterdir()) == [path]
    found, turn = loaded(path)
    within = {'rtol': 0.0, 'atol': ROUNDING.get(ending, 0.0)}
    np.testing.assert_allclose(found.vertices, mesh.vertices, **within)
    np.testing.assert_array_equal(found.faces, mesh.triangles)
    # trimesh makes them unit vectors again, in float64.
    np.testing.assert_allclose(found.vertex_normals, mesh.normals, rtol=0.0, atol=6e-8)
    np.testing.assert_allclose(found.visual.uv, mesh.uv, rtol=0.0, atol=UV_ROUNDING)
    assert ((found.face_normals[:, None] * mesh.normals[mesh.triangles]).sum(axis=-1) > 0.9).all()
    up = (0.0, 1.0, 0.0) if ending in ('.glb', '.gltf') else (0.0, 0.0, 1.0)
    np.testing.assert_array_equal(turn[:3, :3] @ (0.0, 0.0, 1.0), up)
    assert np.linalg.det(turn) == 1.0
    assert not found.is_watertight


def test_a_gltf_opens_by_itself_and_has_two_sides(tmp_path):
    """A viewer would look for a second file, or show nothing from below."""
    write_mesh(wave(WHOLE), tmp_path / 'cloth.gltf')
    tree = json.loads((tmp_path / 'cloth.gltf').read_text())
    assert all(each['uri'].startswith('data:') for each in tree['buffers'])
    assert tree['materials'][0]['doubleSided'] is True
    primitive = tree['meshes'][0]['primitives'][0]
    assert set(primitive['attributes']) == {'POSITION', 'NORMAL', 'TEXCOORD_0'}


def test_an_obj_names_no_other_file(tmp_path):
    """A program would warn of a library of materials that is not there."""
    write_mesh(wave(WHOLE), tmp_path / 'cloth.obj')
    kinds = {line.split()[0] for line in (tmp_path / 'cloth.obj').read_text().splitlines() if line}
    assert kinds == {'#', 'o', 'v', 'vn', 'vt', 'f'}


def value_of(text, name):
    """Return the numbers of an attribute of a stage as an array."""
    found = re.search(rf'^    {re.escape(name)} = (\[.*?\])(?: \($|$)', text, re.MULTILINE)
    return np.array(json.loads(found[1].replace('(', '[').replace(')', ']')))


def test_a_stage_has_the_same_mesh(mesh, tmp_path):
    """Isaac Sim and others would show another cloth, or one that lies on its side."""
    write_mesh(mesh, tmp_path / 'cloth.usda')
    text = (tmp_path / 'cloth.usda').read_text()
    assert text.startswith('#usda 1.0\n')
    assert 'metersPerUnit = 1\n' in text and 'upAxis = "Z"\n' in text
    assert 'defaultPrim = "cloth"\n' in text and 'def Mesh "cloth"\n' in text
    assert text.count('interpolation = "vertex"') == 2
    for name, expected in (
            ('point3f[] points', mesh.vertices), ('normal3f[] normals', mesh.normals),
            ('texCoord2f[] primvars:st', mesh.uv),
            ('float3[] extent', [mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])):
        np.testing.assert_array_equal(value_of(text, name).astype(np.float32), expected)
    np.testing.assert_array_equal(
        value_of(text, 'int[] faceVertexIndices'), mesh.triangles.ravel())
    assert value_of(text, 'int[] faceVertexCounts').tolist() == [3] * len(mesh.triangles)


def test_openusd_opens_a_stage(mesh, tmp_path):
    """The stage would be text that looks like one."""
    usd = pytest.importorskip('pxr.Usd', reason='needs `pip install usd-core`')
    from pxr import UsdGeom
    write_mesh(mesh, tmp_path / 'cloth.usda')
    stage = usd.Stage.Open(str(tmp_path / 'cloth.usda'))
    assert UsdGeom.GetStageUpAxis(stage) == 'Z' and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    prim = UsdGeom.Mesh(stage.GetDefaultPrim())
    indices, counts = prim.GetFaceVertexIndicesAttr().Get(), prim.GetFaceVertexCountsAttr().Get()
    assert prim.ValidateTopology(indices, counts, len(mesh.vertices))[0]
    np.testing.assert_array_equal(np.reshape(indices, (-1, 3)), mesh.triangles)
    np.testing.assert_array_equal(prim.GetPointsAttr().Get(), mesh.vertices)
    np.testing.assert_array_equal(prim.GetNormalsAttr().Get(), mesh.normals)
    uv = UsdGeom.PrimvarsAPI(prim).GetPrimvar('st')
    assert uv.GetInterpolation() == prim.GetNormalsInterpolation() == 'vertex'
    np.testing.assert_array_equal(uv.Get(), mesh.uv)


MESH = wave(WHOLE)
LOST = MESH.vertices.copy()
LOST[7] = np.nan
CHAIN = mesh_of_nodes(np.zeros((1, 4, 3)), np.ones((1, 4, 3)), np.ones((0, 3), bool))


@pytest.mark.parametrize(('mesh', 'name', 'complaint'), [
    (MESH, 'cloth.stl', 'must end in .obj, .ply, .glb, .gltf or .usda, got cloth.stl: give'),
    (MESH, 'cloth', 'must end in .obj, .ply, .glb, .gltf or .usda, got cloth: give'),
    (MESH, 'none/cloth.ply', 'No such file or directory'),
    (CHAIN, 'cloth.glb', 'as of a chain of nodes: give'),
    (replace(MESH, vertices=LOST), 'cloth.usda', '1 of 54 vertices of the mesh are not finite'),
    (replace(MESH, uv=1e39 * MESH.uv.astype(float)), 'cloth.obj', 'uv of the mesh are not finite'),
    (replace(MESH, normals=MESH.normals[1:]), 'cloth.ply', 'normals of a mesh must be'),
    (replace(MESH, triangles=MESH.triangles + 1), 'cloth.ply', '0 to 53, got 1 to 54: give'),
    (replace(MESH, triangles=MESH.triangles - 1), 'cloth.ply', '0 to 53, got -1 to 52: give'),
    (replace(MESH, vertices=None), 'cloth.ply', 'vertices of a mesh must be'),
    ('mesh', 'cloth.ply', 'the mesh must be a Mesh, got a str: give')])
def test_what_cannot_be_written_is_refused(tmp_path, mesh, name, complaint):
    """A user would get a traceback, or a file that no program opens."""
    with pytest.raises(ClothSimError) as error:
        write_mesh(mesh, tmp_path / name)
    assert complaint in str(error.value) and '\n' not in str(error.value)
    assert not list(tmp_path.iterdir())


def test_a_file_is_not_overwritten(tmp_path):
    """The mesh of another time, or work of a user, would be lost."""
    path = tmp_path / 'cloth.ply'
    path.write_text('mine')
    with pytest.raises(ClothSimError, match='already exists, and no mesh is overwritten'):
        write_mesh(MESH, path)
    assert path.read_text() == 'mine'


def test_a_full_disk_leaves_no_half_file(tmp_path):
    """The next try would be refused, as there is a file."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
    try:
        with pytest.raises(ClothSimError, match='cannot be written .*: give another path'):
            write_mesh(MESH, tmp_path / 'cloth.usda')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert not list(tmp_path.iterdir())


def test_without_trimesh_a_stage_can_be_written(tmp_path: Path, monkeypatch):
    """A machine without it would get a traceback, and no mesh at all."""
    monkeypatch.setitem(sys.modules, 'trimesh', None)
    with pytest.raises(ClothSimError, match='run `pip install trimesh`, or write .usda'):
        write_mesh(MESH, tmp_path / 'cloth.obj')
    write_mesh(MESH, tmp_path / 'cloth.usda')
    assert [path.name for path in tmp_path.iterdir()] == ['cloth.usda']
