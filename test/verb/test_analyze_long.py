# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Analysing ten minutes; `python -m pytest --long -s` of this file shows speed and memory."""

import json
from pathlib import Path
import resource
import struct
import subprocess
import sys
import time

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.verb.main import main
import pytest

SCENE = Path(__file__).resolve().parents[2] / 'config' / 'studies' / 'two_corners.yaml'
RATE = 60
SECONDS = 600
REPEATED = 4
# What a child process takes over from its parent counts as its most memory, too, but not here.
_START = """
from cloth_sim_ros.verb.main import main
import sys
assert main() == 0
with open('/proc/self/status') as file:
    print(*(line for line in file if line.startswith('VmHWM')))
"""


@pytest.fixture(scope='module')
def ten_minutes(tmp_path_factory):
    """Return a recording of 36001 frames: 4 s of a run, over and over, with stamps that go on."""
    folder = tmp_path_factory.mktemp('ten_minutes')
    assert main([
        'run', str(SCENE), '--seconds', str(REPEATED), '--record', str(folder), '--set',
        'recording.name=short', '--set', 'rows=64', '--set', 'cols=64', '--set',
        f'publish.rate={RATE}.0']) == 0
    frames = {
        key: [raw.data for raw in BagReader(folder / 'short').messages([f'/cloth_sim/{key}'])]
        for key in ('points', 'stats')}
    recorder = Recorder(folder, 'long')
    for number in range(SECONDS * RATE + 1):
        for key, messages in frames.items():
            data = bytearray(messages[number % len(messages)])
            # The stamp is what every message begins with, behind the 4 bytes of CDR.
            struct.pack_into('<iI', data, 4, *divmod(round(number * 1e9 / RATE), 10**9))
            recorder.write(key, bytes(data), number / RATE)
    recorder.close()
    return recorder.path


@pytest.mark.long
def test_ten_minutes_are_read_in_little_memory(ten_minutes, tmp_path):
    """A long recording could not be analysed, or only on a machine with much memory."""
    begin, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, '-c', _START, 'analyze', str(ten_minutes), '--out', str(tmp_path)],
        check=True, stdout=subprocess.PIPE, text=True)
    wall, after = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    most = int(done.stdout.split('VmHWM:')[1].split()[0]) / 1024
    print(f'measured {SECONDS / wall:.0f} x real time: {wall:.1f} s with plots, of which '
          f'{processor:.1f} s on the processor, {most:.0f} MiB')
    summary = json.loads((tmp_path / 'long' / 'summary.json').read_text())
    assert summary['frames'] == SECONDS * RATE + 1
    assert summary['end'] == pytest.approx(SECONDS)
    assert summary['gaps'] == [] and summary['is_whole']
    # Python and its libraries have 150 MiB, the clouds 6200.
    assert most < 400
