# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Meshes of a cloth as files that other programs open: OBJ, PLY, glTF and USD."""

from collections.abc import Callable
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.usda_mesh import usda_text
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.arguments import array
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import integers
from cloth_sim_ros.sim.arguments import path as checked_path
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.mesh import Mesh
import numpy as np

# The endings of files of each format, the usual one first.
FORMATS = {
    'obj': ('.obj',), 'ply': ('.ply',), 'gltf': ('.glb', '.gltf'), 'usda': ('.usda',)}
_GIVE_OWN = 'give one of Snapshot.mesh()'
_PLACES = {'vertices': 3, 'normals': 3, 'uv': 2}
# Decimals in OBJ files: nanometres.
_DIGITS = 9
# Light grey, visible from both sides.
_MATERIAL = {
    'name': 'cloth', 'baseColorFactor': [0.8, 0.8, 0.8, 1.0], 'metallicFactor': 0.0,
    'roughnessFactor': 0.9, 'doubleSided': True}
# Rotation from z up to the y up of glTF.
_Y_UP = np.array([
    [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def write_mesh(mesh: Mesh, path: str | Path, *, setting: str = 'path') -> None:
    """
    Write ``mesh`` to a new file, in the format that its ending names.

    The endings are .obj, .ply, .usda, .glb and .gltf. Each is a single file with positions [m],
    normals and texture coordinates. z is up, except in glTF, where a node turns the cloth so that
    y is up. All formats but .usda need trimesh.

    :param setting: what ``path`` is called in errors
    :raises ClothSimError: when the file exists or cannot be written, the ending is another one,
        the mesh has no triangles or numbers that are not finite, or trimesh is not installed
    """
    path = checked_target(checked_path(path, 'the file of a mesh'), setting)
    content = _WRITERS[path.suffix.lower()](_checked(mesh))
    try:
        file = path.open('xb')
    except FileExistsError as error:
        raise _is_there(path, setting) from error
    except OSError as error:
        raise _no_file(path, error, setting) from error
    try:
        with file:
            file.write(content)
    except BaseException as error:
        # Half a mesh would be in the way of the next try.
        path.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise _no_file(path, error, setting) from error
        raise


def checked_target(path: Path, setting: str) -> Path:
    """Return ``path``; ClothSimError when there is such a file, or no mesh has its ending."""
    if path.suffix.lower() not in _WRITERS:
        *others, last = _WRITERS
        raise ClothSimError(
            f'the file of a mesh must end in {", ".join(others)} or {last}, got '
            f'{cut(path.name)}: give it one of these endings')
    if os.path.lexists(path):
        raise _is_there(path, setting)
    return path


def _is_there(path: Path, setting: str) -> ClothSimError:
    return ClothSimError(
        f'{cut(path)} already exists, and no mesh is overwritten: give another {setting}')


def _no_file(path: Path, error: OSError, setting: str) -> ClothSimError:
    return ClothSimError(
        f'{cut(path)} cannot be written ({error.strerror}): give another {setting}')


def _checked(mesh: Mesh) -> Mesh:
    """Return ``mesh`` with arrays that every format takes."""
    instance(mesh, Mesh, 'the mesh', _GIVE_OWN)
    vertices = mesh.vertices
    count = len(vertices) if isinstance(vertices, np.ndarray) and vertices.ndim else 0
    found = {
        name: array(getattr(mesh, name), f'the {name} of a mesh', (count, width), _GIVE_OWN)
        for name, width in _PLACES.items()}
    triangles = integers(mesh.triangles, 'the triangles of a mesh', _GIVE_OWN)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or not len(triangles):
        raise ClothSimError(
            f'a mesh needs triangles, (m, 3), got {triangles.shape}, as of a chain of nodes: give '
            'that of a cloth with 2 rows and 2 cols or more')
    if triangles.min() < 0 or triangles.max() >= count:
        raise ClothSimError(
            f'the triangles of a mesh must be of its vertices, 0 to {count - 1}, got '
            f'{triangles.min()} to {triangles.max()}: {_GIVE_OWN}')
    with np.errstate(over='ignore'):
        narrow = {name: values.astype(np.float32) for name, values in found.items()}
    for name, values in narrow.items():
        lost = ~np.isfinite(values).all(axis=1)
        if lost.any():
            raise ClothSimError(
                f'{np.count_nonzero(lost)} of {count} {name} of the mesh are not finite numbers, '
                'as of a run that has blown up: give an earlier time')
    return Mesh(**narrow, triangles=triangles)


def _loaded(mesh: Mesh, has_material: bool = True) -> Any:
    """Return ``mesh`` as a trimesh.Trimesh, with texture coordinates where it has a material."""
    try:
        # Takes half a second.
        import trimesh
    except ImportError:
        raise ClothSimError(
            'trimesh, which writes .obj, .ply, .glb and .gltf, is not installed: run `pip '
            'install trimesh`, or write .usda') from None
    visual = trimesh.visual.TextureVisuals(
        uv=mesh.uv, material=trimesh.visual.material.PBRMaterial(**_MATERIAL))
    return trimesh.Trimesh(
        mesh.vertices, mesh.triangles, vertex_normals=mesh.normals,
        visual=visual if has_material else None, metadata={'name': 'cloth'}, process=False)


def _obj(mesh: Mesh) -> bytes:
    text = _loaded(mesh).export(
        file_type='obj', include_normals=True, digits=_DIGITS, header='cloth_sim_ros: m, z up')
    # The grey material would be a second file.
    lines = (
        line for line in text.splitlines() if not line.startswith(('mtllib', 'usemtl')))
    return '\n'.join(lines).encode()


def _ply(mesh: Mesh) -> bytes:
    loaded = _loaded(mesh, has_material=False)
    loaded.vertex_attributes.update({name: mesh.uv[:, axis] for axis, name in enumerate('st')})
    return loaded.export(file_type='ply', vertex_normal=True)


def _scene(mesh: Mesh) -> Any:
    loaded = _loaded(mesh)
    # It is loaded already.
    import trimesh
    scene = trimesh.Scene()
    scene.add_geometry(loaded, node_name='cloth', geom_name='cloth', transform=_Y_UP)
    return scene


def _glb(mesh: Mesh) -> bytes:
    return _scene(mesh).export(file_type='glb', include_normals=True)


def _gltf(mesh: Mesh) -> bytes:
    files = _scene(mesh).export(
        file_type='gltf', include_normals=True, merge_buffers=True, embed_buffers=True)
    return files['model.gltf']


def _usda(mesh: Mesh) -> bytes:
    return usda_text(mesh).encode()


_WRITERS: dict[str, Callable[[Mesh], bytes]] = {
    '.obj': _obj, '.ply': _ply, '.glb': _glb, '.gltf': _gltf, '.usda': _usda}
