# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Faults of the disk, and of who works on it, while a real node records."""

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import suppress
import os
from pathlib import Path
import resource
import shutil

from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from diagnostic_msgs.msg import DiagnosticStatus
from file_permissions import WITHOUT_OVERRIDE
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
import yaml

START = (
    f'{WITHOUT_OVERRIDE}\nimport sys; from cloth_sim_ros.node.main import main; '
    'sys.exit(main())')
NAME = '/recording_faults/cloth_sim'


@pytest.fixture(scope='module')
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeProcess]:
    """Start the node that the faults happen to."""
    with NodeProcess(
            tmp_path_factory.mktemp('faults'), PAUSED, '-r', '__ns:=/recording_faults',
            start=START) as node:
        yield node


@pytest.fixture(scope='module')
def listening(node: NodeProcess, client: GraphClient) -> ClothUnderTest:
    """Listen to the node once."""
    return ClothUnderTest(client, PAUSED, NAME)


@pytest.fixture
def cloth(listening: ClothUnderTest) -> ClothUnderTest:
    """Bring the node back to its start, paused."""
    listening.restore()
    return listening


def file_removed(_: NodeProcess, path: Path) -> None:
    """Take the mcap file away."""
    mcap(path).unlink()


def file_truncated(_: NodeProcess, path: Path) -> None:
    """Leave a part of the mcap file."""
    os.truncate(mcap(path), mcap(path).stat().st_size - 100)


def file_replaced(_: NodeProcess, path: Path) -> None:
    """Replace the mcap file by a copy."""
    shutil.copy(mcap(path), path / 'copy')
    (path / 'copy').replace(mcap(path))


def folder_removed(_: NodeProcess, path: Path) -> None:
    """Take the whole folder away; the node may be writing metadata.yaml into it."""
    while path.exists():
        shutil.rmtree(path, ignore_errors=True)


def disk_full(_: NodeProcess, path: Path) -> Callable[[], None]:
    """Have what is written beside the mcap file go where there is no room."""
    full = path / 'metadata.yaml.new'
    while not full.is_symlink():
        try:
            full.symlink_to('/dev/full')
        except FileExistsError:
            pass  # the node has it for a moment
    return lambda: full.unlink(missing_ok=True)


def read_only(_: NodeProcess, path: Path) -> Callable[[], None]:
    """Let nobody make files in the folder."""
    path.chmod(0o555)
    return lambda: path.chmod(0o755)


def no_descriptors(node: NodeProcess, _: Path) -> Callable[[], None]:
    """Let the node open no more files."""
    taken = set()
    for link in Path(f'/proc/{node.pid}/fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            # That of a flush is closed in a moment, and its number is free then.
            if link.readlink().name != 'metadata.yaml.new':
                taken.add(int(link.name))
    free = next(number for number in range(len(taken) + 1) if number not in taken)
    return limit(node, resource.RLIMIT_NOFILE, free)


_REMOVED = 'was removed or replaced by another program'
FAULTS = {
    file_removed: (_REMOVED,),
    file_truncated: ('was truncated by another program',),
    file_replaced: (_REMOVED,),
    # A flush that is under way finds no place for metadata.yaml.
    folder_removed: (_REMOVED, 'No such file or directory'),
    disk_full: ('No space left on device',),
    read_only: ('Permission denied',),
    no_descriptors: ('Too many open files',),
}


def gives(text: str, fault: Callable[..., object]) -> bool:
    """Return whether ``text`` gives a reason of ``fault``."""
    return any(reason in text for reason in FAULTS[fault])


def mcap(path: Path) -> Path:
    """Return the file of the recording ``path``."""
    return path / f'{path.name}_0.mcap'


def limit(node: NodeProcess, kind: int, value: int) -> Callable[[], None]:
    """Lower a limit of the node, and return what raises it again."""
    before = resource.prlimit(node.pid, kind)
    resource.prlimit(node.pid, kind, (value, before[1]))
    return lambda: resource.prlimit(node.pid, kind, before) and None


def flushed(path: Path) -> int:
    """Return how many messages of the recording are flushed."""
    content = yaml.safe_load((path / 'metadata.yaml').read_text())
    return content['rosbag2_bagfile_information']['message_count']


def record(cloth: ClothUnderTest) -> Path:
    """Start a recording with something in it, and return its folder."""
    path = Path(cloth.call(StartRecording, 'start_recording').path)
    assert cloth.call(Step, 'step', steps=20).success
    cloth.client.spin_until(lambda: flushed(path) > 0, 'the first flush')
    return path


@pytest.mark.parametrize('running', [
    pytest.param(False, id='paused', marks=pytest.mark.long), pytest.param(True, id='running')])
@pytest.mark.parametrize('fault', FAULTS)
def test_a_fault_is_reported_and_the_simulation_goes_on(cloth, node, fault, running):
    """A run of hours would record into nothing, or end because it cannot be recorded."""
    path = record(cloth)
    cloth.call(SetBool, 'pause', data=not running)
    cloth.clear()
    undo = fault(node, path)
    try:
        cloth.client.spin_until(lambda: is_told(cloth, node, path, fault), 'the end is reported')
        answer = cloth.call(Trigger, 'stop_recording')
        assert not answer.success and gives(answer.message, fault)
        assert cloth.call(SetBool, 'pause', data=True).success
        assert cloth.call(Step, 'step', steps=4).success
    finally:
        if undo is not None:
            undo()
    if fault not in (file_removed, folder_removed):
        assert sum(1 for _ in BagReader(path).messages()) > 0
    again = cloth.call(StartRecording, 'start_recording')
    assert again.success
    assert cloth.call(Trigger, 'stop_recording').success


def is_told(
        cloth: ClothUnderTest, node: NodeProcess, path: Path,
        fault: Callable[..., object]) -> bool:
    """Return whether ~/state, /diagnostics and the log give the end and its reason."""
    said = f'recording to {path} has stopped ('
    in_diagnostics = any(
        status.level == DiagnosticStatus.ERROR and status.message.startswith(said)
        and gives(status.message, fault)
        for array in cloth['diagnostics'] for status in array.status)
    return (
        in_diagnostics and cloth['state'] and not cloth['state'][-1].recording
        and any(said in line and gives(line, fault) for line in node.output.splitlines()))


@pytest.mark.parametrize('fault', [file_removed, file_truncated])
def test_stopping_at_once_is_refused_with_the_reason(cloth, node, fault):
    """A script would get success for closing a recording that does not exist."""
    path = record(cloth)
    cloth.clear()
    fault(node, path)
    answer = cloth.call(Trigger, 'stop_recording')
    assert not answer.success and gives(answer.message, fault)
    # It is published after the answer.
    cloth.wait_for('state', lambda state: not state.recording)


def test_without_descriptors_a_start_is_refused(client, tmp_path):
    """A node that has opened too much would throw an exception, or end."""
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/no_descriptors') as node:
        cloth = ClothUnderTest(client, PAUSED, '/no_descriptors/cloth_sim')
        cloth.frame(0)
        # The first time the code that records is read as well, the second time not.
        for _ in range(2):
            undo = no_descriptors(node, tmp_path)
            try:
                answer = cloth.call(StartRecording, 'start_recording', name='refused')
                assert not answer.success
                assert '(Too many open files): raise the limit of open files' in answer.message
                assert cloth.call(Step, 'step', steps=1).success
            finally:
                undo()
            assert not (tmp_path / 'bags' / 'refused').exists()
            path = cloth.call(StartRecording, 'start_recording').path
            assert cloth.call(Trigger, 'stop_recording').success
            assert sum(1 for _ in BagReader(path).messages()) > 0


def test_a_read_only_directory_refuses_a_start(cloth, node):
    """A node would end, or record nothing without a word."""
    bags = node.folder / 'bags'
    bags.mkdir(exist_ok=True)
    bags.chmod(0o555)
    try:
        answer = cloth.call(StartRecording, 'start_recording')
    finally:
        bags.chmod(0o755)
    assert not answer.success
    assert 'Permission denied): set recording.directory to a writable folder' in answer.message


def test_a_recording_that_has_its_size_is_complete(client, tmp_path):
    """A long run would fill the disk, or a limit leave a broken recording without a word."""
    values = {**PAUSED, 'recording.max_size': 2**20, 'rows': 48, 'cols': 48}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/limited') as node:
        cloth = ClothUnderTest(client, values, '/limited/cloth_sim')
        path = Path(cloth.call(StartRecording, 'start_recording').path)
        cloth.call(SetBool, 'pause', data=False)
        said = f'the recording {path} is complete up to '
        cloth.client.spin_until(
            lambda: cloth['state'] and not cloth['state'][-1].recording, 'the end is reported')
        cloth.wait_for('diagnostics', lambda array: any(
            status.level == DiagnosticStatus.WARN and status.message.startswith(said)
            for status in array.status))
        assert said in node.output
        answer = cloth.call(Trigger, 'stop_recording')
        assert not answer.success and answer.message.startswith(said)
        cloth.clear()
        cloth.wait_for('stats')
    assert sum(file.stat().st_size for file in path.iterdir()) <= 2**20
    reader = BagReader(path)
    assert sum(raw.topic.endswith('points') for raw in reader.messages()) > 3
    assert reader.problems == []
