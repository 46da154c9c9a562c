# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Results of a study are those of the present code."""

import shutil

from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.study.runs.run import code_digest
from cloth_sim_ros.study.runs.run import Run
import pytest


@pytest.fixture
def other_shaders(tmp_path, monkeypatch):
    """Have the digest look at a copy of the shaders, and return its folder."""
    copy = shutil.copytree(shader_directory(), tmp_path / 'shaders')
    monkeypatch.setattr('cloth_sim_ros.study.runs.run.shader_directory', lambda: copy)
    code_digest.cache_clear()
    yield copy
    code_digest.cache_clear()


def test_a_shader_that_changed_makes_another_run(other_shaders):
    """A study that is made again would tell of the code before."""
    run = Run('study_runs:square', {}, {'number': 2})
    before = run.key
    code_digest.cache_clear()
    assert run.key == before
    shader = other_shaders / 'observe.comp'
    shader.write_text(shader.read_text() + '// changed')
    code_digest.cache_clear()
    assert run.key != before
