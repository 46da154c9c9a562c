# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A fingerprint of the code that results rest on."""

from functools import cache
import hashlib
from pathlib import Path

import cloth_sim_ros
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.gl.shader_directory import shader_directory

# Of a source file.
_MOST_BYTES = 1 << 24


@cache
def code_digest() -> str:
    """Return a fingerprint of all Python files and shaders: a version stays while these change."""
    digest = hashlib.sha256()
    for root, pattern in (
            (Path(cloth_sim_ros.__file__).parent, '*.py'), (shader_directory(), '*.*')):
        for path in sorted(root.rglob(pattern)):
            if path.is_file():
                digest.update(f'{path.relative_to(root)}\0'.encode())
                digest.update(read_regular(path, _MOST_BYTES))
    return digest.hexdigest()
