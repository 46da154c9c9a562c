# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
Which tests find mistakes that somebody could make: those of seeded_faults.yaml.

Each is put into the sources of this checkout, alone, and taken out again. First the tests named
for it run, then, where they find nothing, all of the part of the tree that it is in. Needs a
checkout without changes in the files concerned. Beside other work, tests that keep to the wall
clock can fail without a fault.

For example:
  python benchmarks/seeded_faults.py
  python benchmarks/seeded_faults.py --only pin --named --long
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import contextmanager
from dataclasses import dataclass
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import time
from typing import Any
from typing import NoReturn

from cloth_sim_ros.files.checked_yaml import load_yaml

ROOT = Path(__file__).resolve().parents[1]
FAULTS = Path(__file__).with_suffix('.yaml')
# Test folders of the sources outside the package.
_PARTS = {'shaders': ('test/sim', 'test/reference', 'test/study', 'test/rendering')}
# A test that never ends has found something, too [s]: of those named, and of all of a part.
_PATIENCE = (600.0, 7200.0)
_NO_TESTS = 5
_FAILED = re.compile(r'^(?:FAILED|ERROR) (.+?)(?: - .*)?$', re.MULTILINE)


@dataclass(frozen=True)
class Fault:
    """
    A mistake.

    :param name: in few words
    :param breaks: what is wrong then
    :param file: from the root of the checkout
    :param text: what is there once
    :param fault: what takes its place
    :param tests: files and folders that should find it
    """

    name: str
    breaks: str
    file: str
    text: str
    fault: str
    tests: tuple[str, ...]

    @property
    def path(self) -> Path:
        """Return the file in this checkout."""
        return ROOT / self.file

    @property
    def part(self) -> tuple[str, ...]:
        """Return the tests of the part of the tree that the file is in."""
        first, second, *_ = Path(self.file).parts
        return _PARTS.get(first, (f'test/{second}',))

    def put_into(self, source: str) -> str:
        """Return ``source`` with the mistake; ValueError where its text is not there once."""
        count = source.count(self.text)
        if count != 1:
            raise ValueError(
                f'{self.name}: {self.text!r} stands {count} times in {self.file}: choose a text '
                'that stands there once')
        return source.replace(self.text, self.fault)


@dataclass(frozen=True)
class Finding:
    """
    What became of a fault.

    :param test: the first that failed; empty where none did
    :param seconds: until then, wall time
    """

    fault: Fault
    test: str
    seconds: float


def faults(only: str = '') -> list[Fault]:
    """Return the faults whose names contain ``only``."""
    entries: Any = load_yaml(FAULTS)
    found = [Fault(**{**entry, 'tests': tuple(entry['tests'])}) for entry in entries]
    return [fault for fault in found if only in fault.name]


@contextmanager
def seeded(fault: Fault) -> Iterator[None]:
    """Have ``fault`` in this checkout until the end of the block, however that comes."""
    path, status = fault.path, fault.path.stat()
    source = path.read_text(encoding='utf-8')
    faulty = fault.put_into(source)
    try:
        path.write_text(faulty, encoding='utf-8')
        yield
    finally:
        path.write_text(source, encoding='utf-8')
        # What was compiled of it holds again.
        os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def first_failure(tests: Sequence[str], options: Sequence[str], patience: float) -> str:
    """Return the first of ``tests`` that fails in ``patience`` [s]; empty where all pass."""
    # Python dates compiled files in whole seconds, and a fault may last less than one.
    environment = {**os.environ, 'PYTHONDONTWRITEBYTECODE': '1'}
    command = [sys.executable, '-m', 'pytest', '-x', '-q', '-rfE', '--tb=no', *options, *tests]
    process = subprocess.Popen(
        command, cwd=ROOT, env=environment, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT)
    try:
        told, _ = process.communicate(timeout=patience)
    except subprocess.TimeoutExpired:
        return f'a test that hangs, of {" ".join(tests)}'
    finally:
        # Tests leave no node behind when they are interrupted.
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            process.wait()
    if process.returncode in (0, _NO_TESTS):
        return ''
    failed = _FAILED.search(told)
    if failed is None:
        raise RuntimeError(f'pytest ended with {process.returncode}: {told[-2000:]}')
    return failed[1]


def find(fault: Fault, options: Sequence[str] = (), *, widely: bool = True) -> Finding:
    """
    Return what finds ``fault``: a test named for it, or one of its part of the tree.

    :param options: for pytest
    :param widely: False for the tests that are named alone
    """
    begin = time.monotonic()
    test = ''
    with seeded(fault):
        for tests, patience in zip((fault.tests, fault.part)[:1 + widely], _PATIENCE):
            test = test or first_failure(tests, options, patience)
    return Finding(fault, test, time.monotonic() - begin)


def changed_files(found: Sequence[Fault]) -> list[str]:
    """Return which of the files of ``found`` differ from those that were committed."""
    files = sorted({fault.file for fault in found})
    status = subprocess.run(
        ['git', 'status', '--porcelain', '--', *files], cwd=ROOT, check=True,
        capture_output=True, text=True)
    return [line[3:] for line in status.stdout.splitlines()]


def _stop(_number: int, _frame: object) -> NoReturn:
    raise KeyboardInterrupt


def main() -> int:
    """Print a row for each fault; return 1 where one was not found."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--only', default='', metavar='TEXT', help='faults with it in their name')
    parser.add_argument('--named', action='store_true', help='run no tests but those named')
    parser.add_argument('--long', action='store_true', help='run the long tests as well')
    args = parser.parse_args()
    found = faults(args.only)
    changed = changed_files(found)
    if changed:
        parser.error(
            f'{", ".join(changed)} differ from what is committed, and faults are put there: '
            'commit or stash that first')
    signal.signal(signal.SIGTERM, _stop)
    # In the background of a shell it would be ignored, here and by the tests.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    print('| fault: what is wrong then | found by | seconds |')
    print('|---|---|---|')
    missed = 0
    for fault in found:
        finding = find(fault, ['--long'] if args.long else [], widely=not args.named)
        missed += not finding.test
        test = f'`{finding.test}`' if finding.test else 'none'
        print(f'| {fault.breaks} (`{fault.file}`) | {test} | {finding.seconds:.0f} |', flush=True)
    print(f'\n{len(found) - missed} of {len(found)} found')
    return int(missed > 0)


if __name__ == '__main__':
    sys.exit(main())
