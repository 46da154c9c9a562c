# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What became of a run: one line of JSON, and arrays beside it."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field
import json
from typing import Any

from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.study.runs.run import Run
import numpy as np

DONE = 'done'
REFUSED = 'refused'
STOPPED = 'stopped'
FAILED = 'failed'


@dataclass(frozen=True)
class Result:
    """
    What became of one run.

    :param outcome: done; refused, with the reason that the simulation gave; stopped, where its
        state was lost; or failed, with the error, and made again when the study is continued
    :param scene: parameters that the run was given
    :param scene_sha256: fingerprint of all parameters, defaults included
    :param values: what the function returned, without arrays
    :param device: that it ran on; empty where that is not known
    :param wall_seconds: from begin to end of the function; others may have run beside it
    :param arrays: what the function returned as arrays, by name; kept in a file of their own
    """

    key: str
    function: str
    outcome: str
    reason: str
    scene: Mapping[str, Any]
    scene_sha256: str
    settings: Mapping[str, Any]
    values: Mapping[str, Any]
    device: str
    version: str
    wall_seconds: float
    arrays: Mapping[str, np.ndarray] = field(default_factory=dict)

    @property
    def is_done(self) -> bool:
        """Return whether there are values."""
        return self.outcome == DONE

    @property
    def is_final(self) -> bool:
        """Return whether the run need not be made again."""
        return self.outcome != FAILED

    def line(self) -> str:
        """Return the line of JSON, without arrays."""
        plain = {name: value for name, value in vars(self).items() if name != 'arrays'}
        return json.dumps({**plain, 'arrays': sorted(self.arrays)}, allow_nan=False)


def unmade(run: Run, outcome: str, reason: str, **known: Any) -> Result:
    """Return the result of a run that has no values."""
    return Result(**{
        **describe(run), 'outcome': outcome, 'reason': reason, 'values': {}, 'device': '',
        'wall_seconds': 0.0, **known})


def describe(run: Run) -> dict[str, Any]:
    """Return what the result of ``run`` repeats of it."""
    return {
        'key': run.key, 'function': run.function, 'scene': dict(run.scene),
        'scene_sha256': run.scene_sha256, 'settings': dict(run.settings),
        'version': project_version()}
