# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
