# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One run of a study: a function by name and what it is given."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
import hashlib
import json
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.runs.code_digest import code_digest


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
