# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Write the cloth of a recording as a mesh that Blender, MeshLab, Isaac Sim and others open.

The mesh is that of the frame nearest to --at, in metres and with z up (y in glTF), and has normals
and texture coordinates. Colliders are not written. A file that exists is not overwritten. Needs no
node.

For example:
  cloth_sim export bags/drop_test --format gltf
  cloth_sim export bags/drop_test --at 0.5 --format usda --output drop.usda
  cloth_sim export bags/drop_test --at 0.5 --output drop.obj
"""

from argparse import ArgumentParser
from argparse import Namespace
import os
from pathlib import Path

from cloth_sim_ros.analysis.frames import frame_at
from cloth_sim_ros.analysis.mesh_files import checked_target
from cloth_sim_ros.analysis.mesh_files import FORMATS
from cloth_sim_ros.analysis.mesh_files import write_mesh
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.recording_arguments import finite_time
from cloth_sim_ros.verb.recording_arguments import open_recording

_SETTING = '--output'


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)
    parser.add_argument(
        '--at', type=finite_time, metavar='T',
        help='simulated time of the frame to write [s] (default: the last one)')
    parser.add_argument(
        '--format', choices=FORMATS,
        help='format of the file; gltf writes .glb, or .gltf if --output ends so (default: that '
             'of the ending of --output)')
    parser.add_argument(
        '--output', '--out', dest='out', metavar='FILE',
        help='file to write (default: beside BAG, with its name, the time and the format)')


def main(args: Namespace) -> int:
    """Write the mesh, and say of which frame it is and where."""
    target = target_of(args)
    recording = open_recording(args)
    frame = frame_at(recording, args.at)
    if target is None:
        bag = Path(os.path.abspath(recording.path))
        name = bag.stem if bag.is_file() else bag.name
        target = bag.with_name(f'{name}_{frame.time:.9g}s{FORMATS[args.format][0]}')
    mesh = frame.mesh()
    write_mesh(mesh, target, setting=_SETTING)
    print(
        f'the cloth at {frame.time:.9g} s: {len(mesh.vertices)} vertices, {len(mesh.triangles)} '
        'triangles')
    print(target)
    return 0


def target_of(args: Namespace) -> Path | None:
    """Return the file asked for, None for the usual one; ClothSimError when it can't be it."""
    if args.out is None:
        if args.format is None:
            *others, last = FORMATS
            raise ClothSimError(
                f'a mesh needs a format: give --format {", ".join(others)} or {last}, or '
                '--output with the ending of one')
        return None
    target = checked_target(Path(args.out), _SETTING)
    endings = FORMATS.get(args.format)
    if endings and target.suffix.lower() not in endings:
        raise ClothSimError(
            f'a file of --format {args.format} must end in {" or ".join(endings)}, and --output '
            f'in {target.suffix}: give one of the two, or both alike')
    return target
