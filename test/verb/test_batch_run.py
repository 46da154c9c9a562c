# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A command that compiles for long says so, and one that does not is silent."""

import time

from cloth_sim_ros.verb.batch_run import compile_notice
import pytest

PATIENCE = 300.0


def test_a_long_wait_is_explained(capsys: pytest.CaptureFixture):
    """Somebody on a new machine would take the command for hung."""
    said, deadline = '', time.monotonic() + PATIENCE
    with compile_notice('constraint'):
        while not said.endswith('\n') and time.monotonic() < deadline:
            time.sleep(0.05)
            said += capsys.readouterr().err
    assert said == 'compiling shaders for mode constraint ...\n'


def test_a_short_one_is_not(capsys: pytest.CaptureFixture):
    """Every run would begin with a line that says nothing."""
    with compile_notice('adaptive'):
        pass
    time.sleep(0.8)
    assert capsys.readouterr().err == ''


def test_an_error_ends_it(capsys: pytest.CaptureFixture):
    """The reason of a refusal would be followed by a line about shaders."""
    with pytest.raises(ValueError, match='wrong'):
        with compile_notice('adaptive'):
            raise ValueError('wrong')
    time.sleep(0.8)
    assert capsys.readouterr().err == ''
