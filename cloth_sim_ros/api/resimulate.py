# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make a recorded run again from Python."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.resimulation.input_replay import Listener
from cloth_sim_ros.resimulation.recorded_run import recorded_version
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.rerun import Rerun
from cloth_sim_ros.resimulation.verdict import Verdict


def resimulate(
        path: str | Path, changes: Mapping[str, Any] | None = None, *,
        node: str | None = None) -> Verdict:
    """
    Rerun a recorded simulation, with its inputs at their times, and compare all frames.

    :param path: folder of the recording, or its file
    :param changes: parameters of the scene instead of the recorded ones, by name
    :param node: name of the recorded node, with its namespace; None finds it
    :return: ``frames`` has the number of bitwise identical frames, and the errors of the others
    :raises ClothSimError: when the recording can't be read, or does not hold the beginning of its
        run
    :raises DeviceError: when there is no GL device
    """
    recording = Recording(path, node)
    run = RecordedRun(recording)
    rerun = Rerun(run, changes)
    try:
        for _ in rerun.make(Listener()):
            pass
        return Verdict(rerun, run.device, (recorded_version(recording.path), project_version()))
    finally:
        rerun.close()
