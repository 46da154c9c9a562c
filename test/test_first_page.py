# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The first commands of README.md, pasted into two shells."""

import os
from pathlib import Path
import re
import subprocess

from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.look import PUSH_COLOR
import numpy as np
from PIL import Image
from session_processes import kill_all_of

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 600.0
BLOCK = re.compile(r'(?:^ {4}.*\n)+', re.MULTILINE)
# What the environment of the tests has done already.
SET_UP = ('./scripts/setup.sh', '. scripts/env.sh')


def blocks(heading):
    """Return what to type into one terminal after the other, line by line."""
    page = (ROOT / 'README.md').read_text(encoding='utf-8')
    part = page.partition(f'## {heading}\n')[2].partition('\n## ')[0]
    return [
        [line.strip() for line in block.splitlines() if line.strip() not in SET_UP]
        for block in BLOCK.findall(part)]


def patient(line):
    """Return a command that waits for the node for as long as a machine that is busy needs."""
    asks = line.startswith('cloth_sim ') and not line.startswith('cloth_sim render ')
    return f'{line} --timeout {PATIENCE:g}' if asks else line


def shell(folder, lines, **options):
    """Start a shell that is given ``lines`` as if they were pasted, and stops at no error."""
    process = subprocess.Popen(
        ['bash'], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, start_new_session=True, env=dict(os.environ),
        **options)
    process.stdin.write('\n'.join(lines) + '\n')
    return process


def test_the_first_block_makes_a_picture_of_a_fabric(tmp_path):
    """The very first commands of a newcomer would fail, or end without anything to see."""
    (tmp_path / 'config').symlink_to(ROOT / 'config')
    said, _ = shell(tmp_path, ['set -e', *blocks('First pictures')[0]]).communicate(
        timeout=PATIENCE)
    image = np.asarray(Image.open(tmp_path / 'first_pictures.png').convert('RGB')).astype(int)
    blue = image[..., 2] - image[..., 0] > 30
    assert 0.05 < blue.mean() < 0.5, said


def test_the_first_commands_end_with_a_picture_of_the_push(tmp_path):
    """A newcomer would get an error, or a picture of a cloth that nothing happens to."""
    (tmp_path / 'config').symlink_to(ROOT / 'config')
    first, second = blocks('A first cloth in ROS')
    node = shell(tmp_path, first)
    node.stdin.flush()
    try:
        # The first time on a machine, it compiles shaders before.
        assert any('48 x 48 nodes' in line for line in iter(node.stdout.readline, ''))
        setting = [line for line in first if line.startswith('export ')]
        typed = [patient(line) for line in second]
        said, _ = shell(tmp_path, [*setting, *typed]).communicate(timeout=PATIENCE)
    finally:
        kill_all_of(node.pid)
        node.communicate()
    # Errors are printed as `cloth_sim VERB: ...`.
    assert 'Traceback' not in said and 'cloth_sim ' not in said, said
    frames = list(read_frames(Recording(tmp_path / 'bags' / 'my_run')))
    pushed = [bool(frame.acting_pushes) for frame in frames]
    # A fifth of a second is too short to see anything; and it is seen to begin and to end.
    assert sum(pushed) >= 10 and not pushed[-1]
    image = np.asarray(Image.open(tmp_path / 'my_run.png').convert('RGB')).astype(float) / 255.0
    like_an_arrow = np.abs(image - PUSH_COLOR).max(axis=-1) < 0.15
    assert like_an_arrow.sum() > 100
