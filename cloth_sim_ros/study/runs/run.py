# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One run of a study: a function by name, what it is given, and the code that it rests on."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
from functools import cache
import hashlib
import json
from pathlib import Path
from typing import Any

import cloth_sim_ros
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene

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


@dataclass(frozen=True)
class Run:
    """
    What is to be made, in plain values: everything that its result depends on.

    :param function: `module:name` of a function (scene, **settings) that returns plain values and
        NumPy arrays by name, 'device' among them
    :param scene: scene parameters by name; what is not given has its default
    :param settings: the other arguments of the function
    """

    function: str
    scene: Mapping[str, Any] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def key(self) -> str:
        """Tell this run from all others, also by other code."""
        return _digest([self.function, self.scene, self.settings, code_digest()])[:20]

    @property
    def scene_sha256(self) -> str:
        """Return a fingerprint of all parameters of the scene, defaults included."""
        try:
            return _digest(Scene(self.scene).values)
        except ClothSimError:
            return _digest(self.scene)


def _digest(values: Any) -> str:
    text = json.dumps(values, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
