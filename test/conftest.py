# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Give each pytest process a ROS graph of its own, and run long tests only when asked to."""

import gc
import os
import random
import socket

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.device.tuning import OFF
from cloth_sim_ros.sim.device.tuning import VARIABLE
from hypothesis import HealthCheck
from hypothesis import settings
from hypothesis.internal.conjecture import providers
from long_cases import listed_cases
import pytest

# How long an example takes, or to make one, depends on what else the machine does.
settings.register_profile(
    'any_machine', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('any_machine')

# It makes examples of the constants in loaded modules, too: then the whole suite draws others than
# a single test, and any new module draws others for all.
providers._get_local_constants = lambda: providers._local_constants

# Where ROS's own domain_coordinator claims domains too, so that both respect each other.
FIRST_CLAIM_PORT = 32768
DOMAINS = range(1, 101)


def claim_domain() -> tuple[int, socket.socket]:
    """Return a domain that no other test process uses while the socket stays open."""
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        claim = socket.socket()
        try:
            claim.bind(('', FIRST_CLAIM_PORT + domain))
        except OSError:
            claim.close()
        else:
            return domain, claim
    raise RuntimeError(
        f'all ROS domains {DOMAINS[0]} to {DOMAINS[-1]} are taken by other test processes: '
        'wait for one of them to end')


# Files that take long for the number of their tests: begun last, they would keep one process busy
# while the others have nothing left to do.
BEGUN_FIRST = {
    'test_demo.py', 'test_types.py', 'test_node_cost.py', 'test_kills.py', 'test_player.py',
    'test_guarded_node.py', 'test_mode_switch.py', 'test_paper_speeds.py', 'test_pinch.py',
    'test_shared_memory.py', 'test_contact_scenes.py', 'test_stability_runs.py', 'test_bench.py'}

CLAIM = pytest.StashKey[socket.socket]()


@pytest.fixture(scope='session', autouse=True)
def without_worker_threads() -> None:
    """
    Have llvmpipe run in this process without worker threads, whichever test makes a context first.

    It reads that once. Threads make small cloths slower, and float atomics, which the paper's
    solver needs, add up in another order each time.
    """
    try:
        Context(single_thread=True).close()
    except DeviceError:
        pass  # the tests that need a device say so themselves


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --long and --seed."""
    parser.addoption('--long', action='store_true', help='run the tests that take minutes, too')
    parser.addoption('--seed', type=int, help='of the attacks that draw at random')


def pytest_configure(config: pytest.Config) -> None:
    """Set the environment that every node and every child process inherits."""
    domain, config.stash[CLAIM] = claim_domain()
    os.environ['ROS_DOMAIN_ID'] = str(domain)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    # What somebody measured on this machine is no part of the tests.
    os.environ[VARIABLE] = OFF
    # Modules and tests are there to stay: to look through them again and again takes a second.
    gc.disable()


def pytest_collection_finish() -> None:
    """Let garbage be found again, but not looked for in what was collected."""
    gc.freeze()
    gc.enable()


def pytest_unconfigure(config: pytest.Config) -> None:
    """Let other processes have the domain."""
    config.stash[CLAIM].close()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """
    Begin with files that take long; leave the long tests out unless --long asks for them.

    Then no time limits them.
    """
    items.sort(key=lambda item: item.path.name not in BEGUN_FIRST)
    listed = listed_cases()
    ordinary, long_items = [], []
    for item in items:
        is_long = item.get_closest_marker('long') or item.nodeid in listed
        (long_items if is_long else ordinary).append(item)
    if config.getoption('--long'):
        for item in long_items:
            item.add_marker(pytest.mark.timeout(0))
        return
    config.hook.pytest_deselected(items=long_items)
    items[:] = ordinary
