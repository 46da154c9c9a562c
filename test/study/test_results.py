# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs of a study, what became of each, and the folder of their results."""

import os
import shutil

from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.results import code_digest
from cloth_sim_ros.study.results import LINES
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.results import unmade
import pytest


@pytest.fixture
def other_shaders(tmp_path, monkeypatch):
    """Have the digest look at a copy of the shaders, and return its folder."""
    copy = shutil.copytree(shader_directory(), tmp_path / 'shaders')
    monkeypatch.setattr('cloth_sim_ros.study.results.shader_directory', lambda: copy)
    code_digest.cache_clear()
    yield copy
    code_digest.cache_clear()


def test_a_shader_that_changed_makes_another_run(other_shaders):
    """A repeated study would report results of older code."""
    run = Run('study_runs:square', {}, {'number': 2})
    before = run.key
    code_digest.cache_clear()
    assert run.key == before
    shader = other_shaders / 'observe.comp'
    shader.write_text(shader.read_text() + '// changed')
    code_digest.cache_clear()
    assert run.key != before


# Results that are kept are found again.

RUN = Run('study_runs:square', {}, {'number': 2})


def test_two_studies_do_not_write_into_one_folder(tmp_path):
    """Lines of two studies would be mixed, or one would make what the other makes."""
    with ResultsFolder(tmp_path):
        with pytest.raises(ClothSimError, match='another study is writing'):
            ResultsFolder(tmp_path)
    ResultsFolder(tmp_path).__exit__()


@pytest.mark.parametrize('line', [
    'nonsense', '{"key": 1}', '3', '[' * 100_000, '{"key": ' * 100_000, '{"key": []}'],
    ids=lambda line: line[:12])
def test_a_strange_line_is_named(tmp_path, line):
    """A damaged file would end in a traceback, or be written over."""
    first = unmade(RUN, 'failed', 'first').line()
    (tmp_path / LINES).write_text(f'{first}\n{line}\n')
    with pytest.raises(ClothSimError, match='line 2 of'):
        ResultsFolder(tmp_path)


@pytest.mark.parametrize('kind', ['pipe', 'device'])
def test_lines_that_are_no_file_are_refused(tmp_path, kind):
    """A study would wait for ever, or read without an end."""
    if kind == 'pipe':
        os.mkfifo(tmp_path / LINES)
    else:
        (tmp_path / LINES).symlink_to('/dev/zero')
    with pytest.raises(ClothSimError, match='only regular files are read'):
        ResultsFolder(tmp_path)


def test_the_later_line_counts(tmp_path):
    """A run that failed once would have failed for ever."""
    with ResultsFolder(tmp_path) as results:
        results.add(unmade(RUN, 'failed', 'first'))
        results.add(unmade(RUN, 'refused', 'second'))
    with ResultsFolder(tmp_path) as results:
        assert results.find(RUN.key).reason == 'second'
        assert results.find('another') is None


def test_a_folder_that_cannot_be_is_told(tmp_path):
    """A mistyped --out would end in a traceback."""
    (tmp_path / 'file').touch()
    with pytest.raises(ClothSimError, match='give another --out'):
        ResultsFolder(tmp_path / 'file')
