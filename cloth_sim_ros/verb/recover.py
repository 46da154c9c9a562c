# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Repair a truncated or damaged recording for other tools.

Writes all intact messages to a new folder, with the index and the metadata.yaml that rosbag2,
rosbags and Foxglove need. The original is not changed. Needs no node.

For example:
  cloth_sim recover bags/killed_run
  cloth_sim recover bags/killed_run --out bags/whole_run
"""

from argparse import ArgumentParser
from argparse import Namespace
from pathlib import Path

from cloth_sim_ros.recording.recovery import Recovery

_NANOSECONDS = 1e9


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'recording', metavar='BAG', help='folder of the recording, or its mcap file')
    parser.add_argument(
        '--out', metavar='FOLDER',
        help='new folder for the repaired recording (default: BAG_recovered)')


def main(args: Namespace) -> int:
    """Recover, and print what was kept."""
    source = Path(args.recording).expanduser().absolute()
    recovery = Recovery(source)
    if not recovery.problems:
        print(f'{source} is complete: {_extent(recovery)}; nothing was written')
        return 0
    target = Path(args.out).expanduser().absolute() if args.out else source.with_name(
        f'{source.stem if source.is_file() else source.name}_recovered')
    recovery.write(target, '--out')
    print('\n'.join([*recovery.problems, f'kept {_extent(recovery)}', str(target)]))
    return 0


def _extent(recovery: Recovery) -> str:
    seconds = (recovery.end - recovery.begin) / _NANOSECONDS
    return (
        f'{recovery.message_count} messages over {seconds:.6g} s, up to '
        f'{recovery.end / _NANOSECONDS:.6g} s of recorded time')
