# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Check and measure this package on a GPU, in at most eight minutes and without a network.

Needs NumPy, PyOpenGL and PyYAML; with SciPy, two sections measure more. Each section runs in a
process of its own with a time limit: one that fails is reported, and the others continue. Ctrl-C
keeps what was measured. Results are in DIRECTORY/gpu_suite.json and DIRECTORY/gpu_suite.md.

For example:
  python benchmarks/gpu_suite.py --out /tmp/gpu
  python benchmarks/gpu_suite.py --sections states springs
  python benchmarks/gpu_suite.py --quick
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Sequence
import json
from pathlib import Path
import platform
import signal
import subprocess
import sys
import time
from typing import Any

from gpu import asynchronous
from gpu import barriers
from gpu import batches
from gpu import buffer_order
from gpu import cameras
from gpu import device
from gpu import dispatches
from gpu import fused_substeps
from gpu import modes
from gpu import paper
from gpu import passes
from gpu import read_back
from gpu import shaders
from gpu import springs
from gpu import states
from gpu import submissions
from gpu import surface
from gpu import tuning
from gpu.page import page
from gpu.section import Outcome
from gpu.section import run_here
from gpu.section import run_section
from gpu.section import SLOWER

# In order of worth: what comes last is lost first when time is short.
SECTIONS = (
    device.SECTION, buffer_order.SECTION, states.SECTION, shaders.SECTION, barriers.SECTION,
    asynchronous.SECTION, springs.SECTION, modes.SECTION, surface.SECTION, cameras.SECTION,
    tuning.SECTION, passes.SECTION, paper.SECTION, batches.SECTION, fused_substeps.SECTION,
    dispatches.SECTION, submissions.SECTION, read_back.SECTION)
# Wall time of all sections together [s].
TIME_LIMIT = 470.0
_ROOT = Path(__file__).resolve().parents[1]


def commit() -> str:
    """Return the commit of this checkout, or of an offline kit; 'unknown' where none is known."""
    noted = _ROOT / 'commit'
    if noted.is_file():
        return noted.read_text(encoding='utf-8').strip()
    try:
        return subprocess.run(
            ['git', '-C', str(_ROOT), 'rev-parse', '--short', 'HEAD'], capture_output=True,
            text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return 'unknown'


def read_arguments(arguments: Sequence[str] | None = None) -> Namespace:
    """Return what is to be measured."""
    parser = ArgumentParser(description=__doc__.strip().splitlines()[0])
    names = [section.name for section in SECTIONS]
    parser.add_argument('--out', type=Path, default=Path('gpu_suite'), metavar='DIRECTORY',
                        help='folder of the results (default: %(default)s)')
    parser.add_argument('--sections', nargs='+', choices=names, default=names, metavar='NAME',
                        help=f'sections to run, of {", ".join(names)} (default: all)')
    parser.add_argument('--quick', action='store_true',
                        help='small sizes and short turns, as the tests run it on a CPU')
    parser.add_argument('--store-states', action='store_true',
                        help='compute the states that others are compared with; needs SciPy')
    parser.add_argument('--in-process', choices=names, help='used by the suite itself')
    parser.add_argument('--rows', type=Path, help='used by the suite itself')
    return parser.parse_args(arguments)


def write(folder: Path, outcomes: Sequence[Outcome]) -> None:
    """Write JSON and page with what has been found by now."""
    head: dict[str, Any] = {}
    for outcome in outcomes:
        if outcome.name == device.SECTION.name and outcome.rows:
            head |= {name: outcome.rows[0][name] for name in ('device', 'driver')}
    head |= {
        'commit': commit(), 'date': time.strftime('%Y-%m-%d'), 'Python': sys.version.split()[0],
        'machine': f'{platform.system()} {platform.machine()}'}
    folder.mkdir(parents=True, exist_ok=True)
    content = {**head, 'sections': [outcome.as_dict() for outcome in outcomes]}
    (folder / 'gpu_suite.json').write_text(json.dumps(content, indent=1) + '\n', encoding='utf-8')
    (folder / 'gpu_suite.md').write_text(page(head, outcomes), encoding='utf-8')


def run_all(args: Namespace) -> int:
    """Run the sections one after the other; return 1 if one of them was not ok."""
    outcomes: list[Outcome] = []
    begin = time.monotonic()
    for section in SECTIONS:
        if section.name not in args.sections:
            continue
        left = TIME_LIMIT * (SLOWER if args.quick else 1.0) - (time.monotonic() - begin)
        try:
            now = time.monotonic() - begin
            print(f'{section.title} ({section.name}, {now:.0f} s)', flush=True)
            outcome = run_section(section, args.quick, max(left, 1.0))
        except KeyboardInterrupt as interrupt:
            outcomes += filter(None, [getattr(interrupt, 'outcome', None)])
            write(args.out, outcomes)
            print(f'interrupted: {args.out}/gpu_suite.md has what was measured')
            return 130
        outcomes.append(outcome)
        print(f'  {outcome.status}, {outcome.seconds:.1f} s', flush=True)
        if outcome.error:
            print(outcome.error, flush=True)
        write(args.out, outcomes)
    bad = [outcome.name for outcome in outcomes if outcome.status != 'ok']
    print(f'{args.out}/gpu_suite.md: {len(outcomes)} sections, '
          f'{"all ok" if not bad else "not ok: " + ", ".join(bad)}')
    return int(bool(bad))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the suite, or one section of it in this process."""
    args = read_arguments(arguments)
    if args.store_states:
        states.store()
        return 0
    if args.in_process:
        section = next(each for each in SECTIONS if each.name == args.in_process)
        return run_here(section, args.rows, args.quick)
    # A shell has programs that it starts in the background ignore it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    return run_all(args)


if __name__ == '__main__':
    sys.exit(main())
