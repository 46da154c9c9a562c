# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Shaders are put together once, and errors lead to the file and line they come from."""

from pathlib import Path

from cloth_sim_ros.gl import shader_source
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.shader_source import ShaderSource
import pytest


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a shader folder of its own with an include that is wanted twice."""
    (tmp_path / 'include').mkdir()
    (tmp_path / 'include' / 'one.glsl').write_text('float one() { return 1.0; }\n')
    (tmp_path / 'include' / 'two.glsl').write_text(
        '#include "one.glsl"\nfloat two() { return one() + one(); }\n')
    (tmp_path / 'main.comp').write_text(
        '#version 430 core\n#include "one.glsl"\n#include "two.glsl"\nvoid main() {}\n')
    monkeypatch.setattr(shader_source, 'shader_directory', lambda: tmp_path)
    return tmp_path


def test_includes_stand_once(shaders: Path):
    """A function included twice would be defined twice and not compile."""
    assert ShaderSource('main.comp').text.count('float one()') == 1


def test_version_comes_first_and_once(shaders: Path):
    """GLSL takes the version on the first line only."""
    (shaders / 'main.comp').write_text('#version 430 core\nint rows() { return ROWS; }\n')
    text = ShaderSource('main.comp', {'ROWS': 3}).text
    assert text.splitlines()[:2] == ['#version 430 core', '#define ROWS 3']
    assert text.count('#version') == 1


def test_what_a_shader_does_not_use_is_not_defined(shaders: Path):
    """Scenes that differ in it would compile the same program once more."""
    (shaders / 'main.comp').write_text(
        '#version 430 core\nint side() { return SQUARE(BLOCK); }\n')
    text = ShaderSource('main.comp', {
        'ROWS': 3, 'BLOCK': 'WIDTH', 'WIDTH': 2, 'SQUARE(A)': 'A * A',
        'CUBE(A)': 'A * A * A'}).text
    assert text.splitlines()[1:4] == [
        '#define BLOCK WIDTH', '#define WIDTH 2', '#define SQUARE(A) A * A']
    assert 'ROWS' not in text and 'CUBE' not in text


def test_lines_know_their_origin(shaders: Path):
    """A compile error would point into a text that stands in no file."""
    source = ShaderSource('main.comp')
    line = source.text.splitlines().index('float two() { return one() + one(); }') + 1
    assert source.origin(line) == 'two.glsl:2: float two() { return one() + one(); }'


def test_missing_include_is_named(shaders: Path):
    """A misspelt include would be hard to find."""
    (shaders / 'main.comp').write_text('#include "three.glsl"\n')
    with pytest.raises(ShaderError, match='there is no shader three.glsl in'):
        ShaderSource('main.comp')
