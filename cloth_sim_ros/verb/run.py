# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Simulate a scene file without a node and without ROS.

A scene file is a ROS parameter file; parameters that only a node uses are ignored. --record needs
the ROS packages.

For example:
  cloth_sim run config/drape.yaml --seconds 2
  cloth_sim run config/drape.yaml --set rows=128 --set cols=128 --json
  cloth_sim run config/drape.yaml --set 'pins=[top_edge]' --record bags --out state.npz
"""

from argparse import ArgumentParser
from argparse import Namespace
import json
import sys

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.verb.batch_run import add_recording_options
from cloth_sim_ros.verb.batch_run import BatchRun
from cloth_sim_ros.verb.batch_run import recording_changes
from cloth_sim_ros.verb.scene_arguments import add_scene_arguments
from cloth_sim_ros.verb.scene_arguments import read_scene
import numpy as np


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_scene_arguments(parser)
    parser.add_argument('--seconds', type=float, default=1.0, metavar='T',
                        help='simulated time [s] (default: %(default)s)')
    parser.add_argument('--record', metavar='DIR',
                        help='record the run into a new folder in this directory')
    add_recording_options(parser)
    parser.add_argument('--out', metavar='STATE.npz',
                        help='file for the final positions, velocities, strains, flags and '
                             'time')
    parser.add_argument('--json', action='store_true',
                        help='print the result as one line of JSON')


def main(args: Namespace) -> int:
    """Run the scene and report the result."""
    args.changes += recording_changes(args)
    scene, node_values = read_scene(args)
    simulation = Simulation(scene)
    run = BatchRun(simulation, node_values, args.record)
    run.advance(args.seconds)
    last = simulation.snapshot()
    if args.out:
        write_state(args.out, last)
    result = summary(simulation, run, last)
    print(json.dumps(result) if args.json else in_words(result, run.recording_path))
    if run.problem:
        print(f'cloth_sim run: {run.problem}', file=sys.stderr)
    # That of the recording stands there since it came.
    return int(bool(run.problem or run.recording_problem))


def write_state(path: str, last: Snapshot) -> None:
    """Write positions, velocities, strains, flags and time of ``last`` to an npz file."""
    try:
        with open(path, 'wb') as file:
            np.savez(
                file, positions=last.positions, velocities=last.velocities, strain=last.strain,
                flags=last.flags, time=last.time)
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def summary(simulation: Simulation, run: BatchRun, last: Snapshot) -> dict[str, object]:
    """Return the result of a run as plain values."""
    scene = simulation.scene
    node_steps = scene.node_count * run.steps * simulation.substeps
    return {
        'mode': simulation.mode, 'rows': scene.rows, 'cols': scene.cols,
        'dt': simulation.dt, 'substeps': simulation.substeps,
        'sim_seconds': simulation.time, 'wall_seconds': run.wall_seconds,
        'steps': run.steps,
        'node_steps_per_s': node_steps / run.wall_seconds if run.wall_seconds else 0.0,
        'peak_strain': run.peak_strain,
        'max_strain': last.max_strain,
        'kinetic_energy': last.kinetic_energy,
        'total_energy': last.total_energy,
        'finite': not run.problem, 'state_sha256': last.state_sha256, 'device': simulation.device,
    }


def in_words(result: dict[str, object], recording_path: str) -> str:
    """Return the result as a short table."""
    lines = [f'{name:18}{value:.6g}' if isinstance(value, float) else f'{name:18}{value}'
             for name, value in result.items()]
    if recording_path:
        lines.append(f'{"recording":18}{recording_path}')
    return '\n'.join(lines)
