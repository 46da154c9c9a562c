# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings of programs that end badly."""

from pathlib import Path
import signal
import subprocess
import sys

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rosbags.highlevel import AnyReader
import yaml

PROGRAMS = Path(__file__).parent / 'programs'


@pytest.fixture
def start(tmp_path):
    """Return a starter of a program by its name; it records into tmp_path."""
    started = []

    def run(name):
        program = subprocess.Popen(
            [sys.executable, str(PROGRAMS / f'{name}.py'), str(tmp_path)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        started.append(program)
        return program

    yield run
    for program in started:
        program.kill()
        program.communicate()


def read_broken(path):
    """Return the messages of a file without an index, and the topics they are of."""
    entries = []
    with open(path, 'rb') as stream:
        reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
        try:
            for _, channel, _, message in reader.iter_decoded_messages(log_time_order=False):
                entries.append((channel.topic, message))
        except EndOfFile:
            pass
    return entries


def test_a_killed_run_keeps_what_was_flushed(start, tmp_path):
    """A run that is killed, or a machine that runs out of memory, would lose its recording."""
    program = start('killed')
    assert program.stdout.readline() == 'flushed\n'
    program.send_signal(signal.SIGKILL)
    program.wait()
    steps = [message.steps for _, message in read_broken(tmp_path / 'run' / 'run_0.mcap')]
    assert len(steps) >= 50
    assert steps == list(range(len(steps)))
    metadata = yaml.safe_load((tmp_path / 'run' / 'metadata.yaml').read_text())
    assert metadata['rosbag2_bagfile_information']['message_count'] >= 50


def test_a_full_disk_ends_the_recording_and_nothing_else(start, tmp_path):
    """A full disk would end the simulation, or spoil what was recorded before."""
    output, _ = start('full_disk').communicate()
    count, error = output.splitlines()
    assert count == '1'
    assert error.startswith(f'recording to {tmp_path / "run"} has stopped (File too large): ')
    entries = read_broken(tmp_path / 'run' / 'run_0.mcap')
    assert entries[0][0] == '/cloth_sim/stats' and entries[0][1].steps == 1
    metadata = yaml.safe_load((tmp_path / 'run' / 'metadata.yaml').read_text())
    assert metadata['rosbag2_bagfile_information']['message_count'] == len(entries)


def test_interrupts_while_closing_lose_nothing(start, tmp_path):
    """A second Ctrl-C would leave half a file behind."""
    program = start('interrupted')
    assert program.stdout.readline() == 'closing\n'
    program.send_signal(signal.SIGINT)
    program.send_signal(signal.SIGINT)
    program.communicate()
    with AnyReader([tmp_path / 'run']) as reader:
        assert [time for _, time, _ in reader.messages()] == [
            step * 20_000_000 for step in range(12)]


def test_recording_is_complete_without_close(start, tmp_path):
    """A fault elsewhere in the node would leave a recording without an index."""
    program = start('forgetful')
    _, errors = program.communicate()
    assert program.returncode == 1 and 'something else went wrong' in errors
    with AnyReader([tmp_path / 'run']) as reader:
        assert reader.message_count == 50
