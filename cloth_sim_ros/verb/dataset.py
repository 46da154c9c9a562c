# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Make a data set of labelled pictures of a scene, each with another start, fabric, look and camera.

  cloth_sim dataset config/towel_under_camera.yaml --count 200 --seed 1 --out towels

DIR gets images/ (colour), depth/ (16 bits, millimetres, 0 where nothing is), labels/ (0 nothing,
1 the cloth, 2 the first collider ...), nodes/ (positions in metres, and which are seen), samples/
(camera, pose, fabric and look as JSON) and annotations.json in the format of COCO, with the
corners of the cloth as keypoints. A run that was stopped goes on where it was. A sample follows
from the scene, the seed and its number alone.
"""

from argparse import ArgumentParser
from argparse import Namespace
from concurrent.futures import as_completed
from concurrent.futures import BrokenExecutor
from pathlib import Path
import sys
from typing import Any

from cloth_sim_ros.dataset.folder import ANNOTATIONS
from cloth_sim_ros.dataset.folder import DatasetFolder
from cloth_sim_ros.dataset.sample import check_look
from cloth_sim_ros.dataset.sample import make_sample
from cloth_sim_ros.dataset.sheet import write_sheet
from cloth_sim_ros.dataset.variation import Bounds
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of
from cloth_sim_ros.verb.scene_arguments import add_scene_arguments
from cloth_sim_ros.verb.scene_arguments import parse_change
from cloth_sim_ros.verb.scene_arguments import read_scene
from tqdm import tqdm

_MOST = 1_000_000


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of the verb."""
    add_scene_arguments(parser)
    parser.add_argument('--count', type=int, required=True, metavar='N', help='number of samples')
    parser.add_argument('--seed', type=int, default=0, metavar='S',
                        help='random seed of the data set (default: %(default)s)')
    usual = Bounds()
    for name, what in (
            ('seconds', 'simulated time from letting go to the picture [s]'),
            ('distance', 'of the camera from the middle of the cloth [m]'),
            ('elevation', 'of the camera above the horizon [degrees]'),
            ('lift', 'how high a hand lifts a node first, over the width of the cloth')):
        low, high = getattr(usual, name)
        parser.add_argument(f'--{name}', type=float, nargs=2, default=(low, high),
                            metavar=('FROM', 'TO'), help=f'{what} (default: {low:g} {high:g})')
    parser.add_argument('--keep-fabric', action='store_true',
                        help='the fabric of the scene in all samples, not one by chance')
    parser.add_argument('--sheet', metavar='FILE.png',
                        help='write colour, depth and labels of the first samples to this image')
    add_run_arguments(parser, 'dataset')


def main(args: Namespace) -> int:
    """Make the samples that are missing; return the exit code."""
    if not 1 <= args.count <= _MOST or args.seed < 0:
        raise ClothSimError(
            f'--count must be from 1 to {_MOST} and --seed 0 or more, got {args.count} and '
            f'{args.seed}')
    workers = workers_of(args)
    bounds = Bounds(
        tuple(args.seconds), tuple(args.distance), tuple(args.elevation), tuple(args.lift))
    given = _given(args)
    folder = DatasetFolder(args.out, {
        'scene': given, 'seed': args.seed, 'bounds': vars(bounds),
        'keeps_fabric': args.keep_fabric})
    missing = folder.missing(args.count)
    lost: list[str] = []
    if missing:
        with workers.executor(min(workers.processes, len(missing))) as (executor, _):
            futures = {
                executor.submit(
                    make_sample, given, str(folder.path.resolve()), args.seed, number, bounds,
                    keeps_fabric=args.keep_fabric): number for number in missing}
            with tqdm(total=args.count, initial=args.count - len(missing), unit=' samples',
                      disable=None) as bar:
                for future in as_completed(futures):
                    try:
                        reason = future.result()
                    except BrokenExecutor as error:
                        raise ClothSimError(
                            'a worker process has ended: run the same command again to go on, '
                            'with fewer --jobs if memory was short') from error
                    if reason:
                        lost.append(f'sample {futures[future]}: {reason}')
                    bar.update()
    there = folder.annotate(args.count)
    if args.sheet:
        try:
            write_sheet(folder.path, args.count, Path(args.sheet))
        except (OSError, ValueError) as error:
            raise ClothSimError(
                f'--sheet {cut(args.sheet)} cannot be written ({error}): give a file that ends '
                'in .png') from error
    for reason in lost:
        print(f'cloth_sim dataset: {reason}', file=sys.stderr)
    print(f'{there} samples in {folder.path}, described in {folder.path / ANNOTATIONS}')
    return 0


def _given(args: Namespace) -> dict[str, Any]:
    """Return the values of the scene as they are given, once they are known to be right."""
    scene, _ = read_scene(args)
    check_look(scene)
    given = load_parameters(args.scene)
    for path in args.params:
        given.update(load_parameters(path))
    given.update(map(parse_change, args.changes))
    names = {field.name for field in all_fields(given)}
    return {name: value for name, value in given.items() if name in names}
