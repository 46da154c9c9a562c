# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Rerun a recorded simulation from its recording alone.

The scene and the inputs (pushes, pins, pin targets, mode switches, resets) are read from the
recording; inputs are applied at their simulated times. With the same settings on the same device
the result is bitwise identical; if it is not, the exit code is 1. --set applies the inputs to a
modified scene; a mode set this way applies to the whole run. Only --out and --compare need ROS.

For example:
  cloth_sim resimulate bags/my_run
  cloth_sim resimulate bags/my_run --set mode=constraint --out bags --compare
"""

from argparse import ArgumentParser
from argparse import Namespace
from contextlib import AbstractContextManager
from contextlib import nullcontext
from tempfile import TemporaryDirectory
from typing import Any

from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.recording.bag_folder import fresh_name
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.resimulation.recorded_run import recorded_version
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.rerun import Rerun
from cloth_sim_ros.resimulation.verdict import Verdict
from cloth_sim_ros.resimulation.verdict import version_lines
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.verb import analyze
from cloth_sim_ros.verb.recording_arguments import add_recording_arguments
from cloth_sim_ros.verb.recording_arguments import open_recording
from cloth_sim_ros.verb.scene_arguments import parse_change
from tqdm import tqdm

_BAR = '{percentage:3.0f}% |{bar}| {n}/{total} frames{postfix}'


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    add_recording_arguments(parser)
    parser.add_argument('--set', action='append', default=[], metavar='name=value', dest='changes',
                        help='set a scene parameter; can be given several times')
    parser.add_argument('--out', metavar='DIR',
                        help='record the new run into a new folder in this directory')
    parser.add_argument('--compare', action='store_true',
                        help='compare both runs like `cloth_sim analyze`; with --out, write its '
                             'files there')


def main(args: Namespace) -> int:
    """Run again, and report the comparison."""
    changes = dict(parse_change(change) for change in args.changes)
    _refuse_node_names(changes)
    recording = open_recording(args)
    with _folder(args) as folder:
        run = RecordedRun(recording)
        refuse_unknown(changes, all_fields({**run.scene.values, **changes}))
        rerun = Rerun(run, changes)
        listener = _listener(run, rerun, folder)
        try:
            _make(rerun, listener, recording.count('points') or recording.count('stats'))
        except KeyboardInterrupt:
            if args.out:
                listener.close_interrupted()
            raise
        finally:
            listener.close()
        verdict = Verdict(
            rerun, run.device, (recorded_version(recording.path), project_version()))
        lines = verdict.lines() + recording.problems + version_lines(
            run.scene.missing, run.scene.unknown(NODE_FIELDS), frozenset(changes))
        print('\n'.join(lines))
        rerun.close()
        if args.out:
            print(f'recorded into {listener.path}')
        if args.compare:
            _compare(run, listener.path, f'{listener.path}_compared' if args.out else None)
    return int(verdict.is_failure or bool(listener.problem))


def _folder(args: Namespace) -> AbstractContextManager[str | None]:
    """Return where the new run is recorded: nowhere when nobody wants to read it."""
    if args.compare and not args.out:
        return TemporaryDirectory()
    return nullcontext(args.out)


def _compare(run: RecordedRun, new: str, out: str | None) -> None:
    try:
        analyze.main(Namespace(recordings=[str(run.path), new], node=run.node, out=out, npz=False))
    except ClothSimError as error:
        print(error)


def _refuse_node_names(changes: dict[str, Any]) -> None:
    node_names = [field.name for field in NODE_FIELDS]
    for name in changes:
        if name in node_names:
            raise ClothSimError(
                f'{name} is not a scene parameter: frames and inputs come from the recording, and '
                'only the scene can be changed')


def _listener(run: RecordedRun, rerun: Rerun, folder: str | None) -> Listener:
    if folder is None:
        return Listener()
    # The ROS packages are needed for a recording alone.
    from cloth_sim_ros.verb.resimulated_recording import ResimulatedRecording
    values = {field.name: run.scene.other(field) for field in NODE_FIELDS}
    # The run is to be recorded whole, whatever the first recording was limited to.
    values['recording.max_size'] = 0
    values['recording.name'] = fresh_name(folder, f'{run.name}_again')
    return ResimulatedRecording(rerun.simulation, values, folder, run.node)


def _make(rerun: Rerun, listener: Listener, frames: int) -> None:
    with tqdm(total=frames, bar_format=_BAR, mininterval=0.2, disable=None) as bar:
        for time in rerun.make(listener):
            bar.set_postfix_str(f'{time:.2f} s', refresh=False)
            bar.update(min(1, bar.total - bar.n))
