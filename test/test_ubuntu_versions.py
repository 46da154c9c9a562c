# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What needs no ROS works with the Python packages of Ubuntu 24.04, too."""

import os
from pathlib import Path
import subprocess
import venv

import pytest

ROOT = Path(__file__).resolve().parents[1]
WITHOUT_ROS = ('test/gl', 'test/sim', 'test/reference', 'test/shaders')


@pytest.mark.long
def test_the_simulation_runs_with_older_packages(tmp_path: Path):
    """A user with Ubuntu's own NumPy and PyOpenGL could not run it."""
    venv.create(tmp_path, with_pip=True)
    python = tmp_path / 'bin' / 'python'
    # The ROS wheels' own bootstrapping must not reach into this environment.
    environment = {
        name: value for name, value in os.environ.items()
        if name not in ('LD_LIBRARY_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE')}
    subprocess.run(
        [python, '-m', 'pip', 'install', '-q', '-r', ROOT / 'requirements' / 'ubuntu-24.04.txt'],
        check=True, env=environment)
    done = subprocess.run(
        [python, '-m', 'pytest', '-q', *WITHOUT_ROS], cwd=ROOT, capture_output=True, text=True,
        env={**environment, 'PYTHONPATH': f'{ROOT}:{ROOT / "test" / "support"}'})
    assert done.returncode == 0, done.stdout
