# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The table of what the tuning constants of the code change."""

from pathlib import Path

from constants import CONSTANTS
from constants import SCENES
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    'constant', CONSTANTS, ids=lambda constant: f'{Path(constant.file).name}-{constant.name}')
def test_each_constant_is_where_it_is_said_to_be(constant, tmp_path):
    """A name that is gone ends the benchmark when its turn comes, after an hour."""
    default = constant.default(ROOT)
    assert default not in constant.values
    assert set(constant.scenes) <= set(SCENES)
    copy = tmp_path / constant.file
    copy.parent.mkdir(parents=True)
    copy.write_text((ROOT / constant.file).read_text(encoding='utf-8'), encoding='utf-8')
    for value in constant.values:
        constant.replace(tmp_path, value)
        assert constant.default(tmp_path) == value
