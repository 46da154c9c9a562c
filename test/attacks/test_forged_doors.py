# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Forged messages that are played, times of centuries, and numbers that mean something else."""

from pathlib import Path
import random

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / 'bags' / 'example'
FORGED = (b'', b'\0', b'\xff\xff\xff\xff', b'\xff\xff\xff\x7f', b'\0\0\0\x80', b'\1\0\1\0')


def forged(folder, seed):
    """Record the example with other bytes somewhere in every third message; return how many."""
    drawn = random.Random(seed)
    recorder = Recorder(folder, f'bag_{seed}', 'cloth_sim')
    begin, count = None, 0
    for message in BagReader(EXAMPLE).messages():
        begin = message.time if begin is None else begin
        data = message.data
        if drawn.random() < 0.3:
            count += 1
            bytes_there = drawn.choice(FORGED)
            at = drawn.randrange(0, min(len(data), 200), 4)
            data = data[:at] + bytes_there + (data[at + 4:] if bytes_there else b'')
        recorder.write(
            message.topic.removeprefix('/cloth_sim/').removeprefix('/'), data,
            (message.time - begin) * 1e-9)
    recorder.close()
    return recorder.path, count


@pytest.mark.parametrize('bags', [4, pytest.param(200, marks=pytest.mark.long)])
def test_forged_messages_end_no_player(verbs, tmp_path, usual_seed, bags):
    """A forged length ended `cloth_sim play` with RCLError, or made its readers fail."""
    left_out = 0
    for number in range(bags):
        bag, count = forged(tmp_path, usual_seed + number)
        outcome = verbs.run('play', bag, '--delay', 0, '--rate', 1e6, '--clock')
        assert outcome.code == 0, outcome
        assert 'Traceback' not in outcome.err and 'RCLError' not in outcome.err, outcome
        left_out += 'left out, as they are damaged' in outcome.err
        print(f'{count} of the messages forged: {outcome.out.strip()}')
    assert left_out == bags


@pytest.mark.parametrize('time', [2.0**31, 1e12, 2.0**63 * 1e-9 - 1.0])
def test_times_of_centuries_are_refused(verbs, tmp_path, time):
    """A player waited for 292 years, without a word."""
    recorder = Recorder(tmp_path, 'bag')
    state = next(
        message.data for message in BagReader(EXAMPLE).messages(['/cloth_sim/stats']))
    for at in (0.0, 0.1, min(time, 2.0**63 * 1e-9 - 1.0)):
        recorder.write('stats', state, at)
    recorder.close()
    outcome = verbs.run('play', recorder.path)
    assert outcome.code == 1 and len(outcome.err.strip().splitlines()) == 1, outcome
    assert 'longer than the' in outcome.err and '--duration' in outcome.err


@pytest.mark.parametrize('value', ['2', '1', '100', '1e300', 'inf', 'nan', '0', '-0.02'])
@pytest.mark.parametrize('option', ['--budget-strain', '--budget-error'])
def test_percentages_are_refused_before_a_study(verbs, tmp_path, option, value):
    """A study of hours would be made for 200 %."""
    outcome = verbs.run(
        'study', 'tradeoff', ROOT / 'config' / 'towel.yaml', f'{option}={value}', '--out',
        tmp_path / 'out')
    assert outcome.code == 1 and 'runs in' not in outcome.err, outcome
    assert len(outcome.err.strip().splitlines()) == 1 and option in outcome.err
    assert not (tmp_path / 'out').exists()
