# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Why a recording cannot begin or go on."""

import errno
import os
from pathlib import Path

from cloth_sim_ros.recording.recording_faults import ending
from cloth_sim_ros.recording.recording_faults import FileChangedError
from cloth_sim_ros.recording.recording_faults import refusal
import pytest

WAYS_OUT = {
    errno.ENOSPC: 'free disk space, or set recording.directory to another disk',
    errno.EDQUOT: 'free disk space, or set recording.directory to another disk',
    errno.EFBIG: 'free disk space, or set recording.directory to another disk',
    errno.EMFILE: 'raise the limit of open files (ulimit -n), or close some',
    errno.ENFILE: 'raise the limit of open files (ulimit -n), or close some',
    errno.EROFS: 'set recording.directory to a writable folder',
    errno.EACCES: 'set recording.directory to a writable folder',
    errno.EIO: 'set recording.directory to a writable folder',
}


@pytest.mark.parametrize('number', WAYS_OUT)
def test_each_fault_has_its_way_out(number):
    """A user would make room on a disk that has room."""
    error = OSError(number, os.strerror(number))
    refused = str(refusal(Path('/bags'), error, 'recording.directory'))
    assert refused == (
        f'cannot record into /bags ({os.strerror(number)}): {WAYS_OUT[number]}')
    ended = str(ending(Path('/bags/run'), error, 'recording.directory'))
    assert ended == (
        f'recording to /bags/run has stopped ({os.strerror(number)}): {WAYS_OUT[number]}, and '
        'start a new one')


def test_a_file_that_was_changed_is_no_matter_of_the_folder():
    """A user would move recordings to another disk, where the same program changes them."""
    ended = str(ending(Path('/bags/run'), FileChangedError('run_0.mcap was removed'), '--record'))
    assert '(run_0.mcap was removed): leave the folder of a recording alone' in ended


def test_a_thread_that_cannot_start_has_its_way_out():
    """A user would look for a fault of the disk."""
    refused = str(refusal(Path('/bags'), RuntimeError("can't start new thread"), '--record'))
    assert "(can't start new thread): close other programs, or raise the limits" in refused
