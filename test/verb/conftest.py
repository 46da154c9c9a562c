# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A paused node for the verbs to talk to."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import dataclass

from cloth_sim_ros.verb.main import main
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from graph_client import GraphClient
from graph_fixtures import client  # noqa: F401
from graph_fixtures import discovery  # noqa: F401
from node_process import NodeProcess
import pytest

NAMESPACE = '/verbs'
NODE = f'{NAMESPACE}/cloth_sim'


@pytest.fixture(scope='session')
def verb_node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeProcess]:
    """Start the node."""
    folder = tmp_path_factory.mktemp('verb_node')
    with NodeProcess(folder, PAUSED, '-r', f'__ns:={NAMESPACE}') as node:
        yield node


@pytest.fixture(scope='session')
def listening_cloth(verb_node: NodeProcess) -> Iterator[ClothUnderTest]:
    """Listen to the node."""
    with GraphClient() as listener:
        yield ClothUnderTest(listener, PAUSED, NODE)


@pytest.fixture
def cloth(listening_cloth: ClothUnderTest) -> ClothUnderTest:
    """Bring the node back to its start, paused."""
    listening_cloth.restore()
    return listening_cloth


@dataclass
class Result:
    """What a verb leaves behind."""

    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def verb(
        cloth: ClothUnderTest,
        capsys: pytest.CaptureFixture[str]) -> Callable[..., Result]:
    """Run a verb on the node."""
    def run(*arguments: str) -> Result:
        capsys.readouterr()
        try:
            code = main([*arguments, '--node', NODE, '--timeout', '120'])
        except SystemExit as stop:
            code = stop.code
        return Result(code, *capsys.readouterr())

    return run
