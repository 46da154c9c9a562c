# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The measurement behind docs/notes/performance.md."""

from cloth_sim_ros.rendering.render_cost import main
from cloth_sim_ros.rendering.render_cost import wavy_cloth
import numpy as np


def test_it_measures_each_size(capsys):
    """The table in the docs could not be made again."""
    main(sides=(5, 8), rounds=2)
    lines = capsys.readouterr().out.splitlines()
    assert [line[:14].split() for line in lines[2:]] == 2 * [['5', 'x', '5']] + 2 * [
        ['8', 'x', '8']]
    assert all(float(line.split()[4]) > 0.0 for line in lines[2:])


def test_the_cloth_is_a_cloth():
    """Something else than a cloth would be measured."""
    frame = wavy_cloth(20)
    assert frame.positions.shape == (20, 20, 3)
    np.testing.assert_allclose(np.linalg.norm(frame.normals, axis=-1), 1.0, atol=1e-6)
