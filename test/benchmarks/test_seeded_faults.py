# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The list of mistakes that tests have to find, and how they are put into the sources."""

import subprocess

import pytest
import seeded_faults
from seeded_faults import changed_files
from seeded_faults import Fault
from seeded_faults import faults
from seeded_faults import find
from seeded_faults import ROOT
from seeded_faults import seeded

FAULT = Fault('more', 'too much', 'place/module.py', 'LESS = 1', 'LESS = 2', ('test_less.py',))
SOURCE = 'LESS = 1\nMORE = 2\n'


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """Return a checkout of one module and its test."""
    monkeypatch.setattr(seeded_faults, 'ROOT', tmp_path)
    (tmp_path / 'place').mkdir()
    (tmp_path / 'place/module.py').write_text(SOURCE)
    (tmp_path / 'test_less.py').write_text(
        'from place.module import LESS\n\n\ndef test_less():\n    assert LESS < 2\n')
    return tmp_path


@pytest.mark.parametrize('fault', faults(), ids=lambda fault: fault.name)
def test_every_fault_can_still_be_seeded(fault):
    """A fault would count as found, or as missed, that is not in the sources any more."""
    source = fault.path.read_text(encoding='utf-8')
    assert fault.put_into(source) != source
    assert fault.breaks
    assert all((ROOT / place).exists() for place in (*fault.tests, *fault.part))


def test_there_are_forty_seven_in_all_parts_of_the_tree():
    """The list would say nothing of a whole part of the project."""
    assert len({fault.name for fault in faults()}) == len(faults()) == 47
    assert {fault.part for fault in faults()} >= {
        (f'test/{part}',) for part in (
            'sim', 'node', 'messages', 'recording', 'playback', 'analysis', 'resimulation',
            'files', 'verb', 'gym', 'rendering')}


def test_a_fault_is_found_and_taken_out_again(checkout):
    """The table would name a test that finds nothing, or the next fault would come on top."""
    finding = find(FAULT)
    assert finding.test == 'test_less.py::test_less'
    assert finding.seconds > 0.0
    assert FAULT.path.read_text() == SOURCE


def test_a_fault_that_no_test_finds_is_told(checkout):
    """A gap in the tests would not be seen."""
    harmless = Fault('same', '', 'place/module.py', 'MORE = 2', 'MORE = 3', FAULT.tests)
    (checkout / 'test/module.py').mkdir(parents=True)
    assert find(harmless).test == ''


def test_an_interrupt_leaves_the_sources_as_they_were(checkout):
    """Ctrl-C would leave a mistake in the checkout, and somebody would commit it."""
    before = FAULT.path.stat().st_mtime_ns
    with pytest.raises(KeyboardInterrupt), seeded(FAULT):
        assert 'LESS = 2' in FAULT.path.read_text()
        raise KeyboardInterrupt
    assert FAULT.path.read_text() == SOURCE
    assert FAULT.path.stat().st_mtime_ns == before


@pytest.mark.parametrize('source', ['', 2 * SOURCE])
def test_a_fault_without_one_place_is_refused(source):
    """It would be put in nowhere, or in two places."""
    with pytest.raises(ValueError, match='choose a text that stands there once'):
        FAULT.put_into(source)


def test_changes_are_not_mixed_with_faults(checkout):
    """What somebody works on would be lost when a fault is taken out."""
    git = ('git', '-c', 'user.name=nobody', '-c', 'user.email=nobody')
    for command in (('init', '-q'), ('add', '.'), ('commit', '-qm', 'all')):
        subprocess.run([*git, *command], cwd=checkout, check=True)
    assert changed_files([FAULT]) == []
    FAULT.path.write_text('LESS = 0\n')
    assert changed_files([FAULT]) == [FAULT.file]
