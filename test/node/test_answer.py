# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Service answers."""

from types import SimpleNamespace

from cloth_sim_ros.node.answer import answer
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


def test_tells_what_was_done():
    """A request that was carried out would not be answered with success."""
    callback = answer(lambda request, response: f'did {request}')
    response = callback('this', SimpleNamespace())
    assert (response.success, response.message) == (True, 'did this')


def test_tells_why_not():
    """A refused request would end the node, or be answered without the reason."""
    def refuse(request, response):
        raise ClothSimError('too much: take less')

    response = answer(refuse)(None, SimpleNamespace())
    assert (response.success, response.message) == (False, 'too much: take less')


def test_lets_faults_of_the_program_through():
    """A fault of the program would look like a mistake of the user."""
    def fail(request, response):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        answer(fail)(None, SimpleNamespace())
