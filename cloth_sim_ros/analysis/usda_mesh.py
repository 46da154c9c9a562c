# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A mesh in the text form of OpenUSD.

The library of OpenUSD would take 200 MB on the disk for these 30 lines.
"""

from cloth_sim_ros.sim.mesh import Mesh
import numpy as np


def usda_text(mesh: Mesh) -> str:
    """Return a stage with ``mesh`` as its one prim, /cloth, in metres and with z up."""
    return f"""#usda 1.0
(
    defaultPrim = "cloth"
    doc = "Written by cloth_sim_ros"
    metersPerUnit = 1
    upAxis = "Z"
)

def Mesh "cloth"
{{
    uniform bool doubleSided = 1
    float3[] extent = {_tuples(np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)]))}
    int[] faceVertexCounts = {_list(np.full(len(mesh.triangles), 3))}
    int[] faceVertexIndices = {_list(mesh.triangles.ravel())}
    normal3f[] normals = {_tuples(mesh.normals)} (
        interpolation = "vertex"
    )
    point3f[] points = {_tuples(mesh.vertices)}
    texCoord2f[] primvars:st = {_tuples(mesh.uv)} (
        interpolation = "vertex"
    )
    uniform token subdivisionScheme = "none"
}}
"""


def _list(numbers: np.ndarray) -> str:
    return f'[{", ".join(map(str, numbers.tolist()))}]'


def _tuples(vectors: np.ndarray) -> str:
    # Nine digits give every float32 back.
    one = f'({", ".join(["%.9g"] * vectors.shape[1])})'
    return f'[{", ".join(one % tuple(vector) for vector in vectors.tolist())}]'
