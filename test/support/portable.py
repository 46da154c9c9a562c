# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether the reference compiler of GLSL accepts a shader."""

from collections.abc import Mapping
from pathlib import Path
import subprocess

from cloth_sim_ros.gl.shader_source import ShaderSource


def assert_accepted(folder: Path, name: str, defines: Mapping[str, object]) -> None:
    """
    Assert it of the shader ``name`` with ``defines``.

    :param folder: to write into
    """
    source = ShaderSource(name, defines)
    assert source.text.startswith('#version 430 core\n')
    path = folder / Path(name).name
    path.write_text(source.text)
    done = subprocess.run(['glslangValidator', str(path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
