# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Reports as files."""

import subprocess
import sys

# 300000 points that go up and down: the outline of such a line fills the whole plot.
_DRAW = """
from cloth_sim_ros.analysis.report_files import write_plot
from matplotlib.figure import Figure
import numpy as np
from pathlib import Path
import sys

def most():
    with open('/proc/self/status') as file:
        return next(int(line.split()[1]) for line in file if line.startswith('VmHWM'))

def draw(count):
    figure = Figure()
    figure.subplots().plot(np.arange(count), np.random.default_rng(1).random(count))
    write_plot(figure, Path(sys.argv[1]))

draw(10)
before = most()
draw(300_000)
print((most() - before) / 1024)
"""


def test_long_lines_are_drawn_in_little_memory(tmp_path):
    """The plots of a long run would take more memory than reading it."""
    done = subprocess.run(
        [sys.executable, '-c', _DRAW, str(tmp_path / 'plot.png')], check=True,
        stdout=subprocess.PIPE, text=True)
    # The points alone, as matplotlib keeps them, take 20 MiB; in one piece it would be 180.
    assert float(done.stdout) < 60
