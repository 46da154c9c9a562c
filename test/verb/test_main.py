# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The command as a whole."""

from pathlib import Path
import subprocess
import sys

from cloth_sim_ros.verb.main import main
from cloth_sim_ros.verb.main import VERBS
from command import cloth_sim
import pytest

EXAMPLE = str(Path(__file__).resolve().parents[2] / 'bags' / 'example')


@pytest.mark.parametrize('verb', VERBS)
def test_every_verb_has_help_with_an_example(verb, capsys):
    """A user would have to read the source to use a verb."""
    with pytest.raises(SystemExit) as stop:
        main([verb, '--help'])
    assert stop.value.code == 0
    assert f'  cloth_sim {verb}' in capsys.readouterr().out


def test_lists_its_verbs(capsys):
    """A user would not learn what the command can do."""
    with pytest.raises(SystemExit) as stop:
        main(['--help'])
    assert stop.value.code == 0
    text = capsys.readouterr().out
    assert all(f'  {verb} ' in text for verb in VERBS)


@pytest.mark.parametrize('arguments', [[], ['--seconds', '2']])
def test_asks_for_a_verb(arguments, capsys):
    """A command without a verb would do nothing, in silence."""
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    assert 'VERB' in capsys.readouterr().err


@pytest.mark.parametrize('name, hint', [
    ('rnu', 'did you mean run?'), ('analyse', 'did you mean analyze?'),
    ('PUSH', 'did you mean push?'),
    ('dance', 'choose one that cloth_sim --help lists'),
    ('x' * 1000, 'choose one that cloth_sim --help lists')])
def test_says_which_verb_may_be_meant(name, hint, capsys):
    """A user would have to find a mistyped verb in the whole list, or run another one."""
    assert main([name, 'scene.yaml']) == 2
    told = capsys.readouterr()
    assert told.out == ''
    assert told.err.startswith(f"cloth_sim: there is no verb '{name[:100]}")
    assert told.err.endswith(f': {hint}\n') and len(told.err) < 400


@pytest.mark.parametrize('arguments', [
    ('info', EXAMPLE), ('materials',), ('analyze', EXAMPLE, '--out', '.')])
@pytest.mark.parametrize('program', ['true', 'head -1'])
def test_nobody_reads_the_output(tmp_path, arguments, program):
    """`cloth_sim info ... | head` ended with a traceback of BrokenPipeError."""
    line = f'{sys.executable} -m cloth_sim_ros.verb {" ".join(arguments)} 2>err | {program}'
    done = subprocess.run(
        ['bash', '-c', f'{line} > /dev/null; echo ${{PIPESTATUS[0]}}'], cwd=tmp_path,
        capture_output=True, text=True, timeout=300)
    # Whether the reader has gone before the output comes is chance with head, and certain with
    # true, which ends at once: Python takes longer to start.
    assert done.stdout.strip() in (('141',) if program == 'true' else ('0', '141'))
    assert (tmp_path / 'err').read_text() == ''


def test_errors_that_nobody_reads(tmp_path):
    """`cloth_sim info nothing 2>&1 | true` ended with a traceback, and code 120."""
    done = subprocess.run(
        ['bash', '-c', f'{sys.executable} -m cloth_sim_ros.verb info nothing 2>&1 | true; '
         'echo ${PIPESTATUS[0]}'], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.stdout.strip() == '141' and done.stderr == ''


def test_a_broken_pipe_elsewhere_is_told(tmp_path):
    """An error of another pipe, as of a video program, would end a verb in silence."""
    result = cloth_sim('materials', before=(
        'import cloth_sim_ros.verb.materials as verb\n'
        'def fail(_): raise BrokenPipeError(32, "of something else")\n'
        'verb.main = fail'))
    assert result.returncode == 1 and 'of something else' in result.stderr


def test_says_that_no_node_answers():
    """A verb would hang, or end with a traceback, when no node runs."""
    result = cloth_sim('pause', '--node', '/nobody/there', '--timeout', '0.3')
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert 'no node offers /nobody/there/pause within 0.3 s' in result.stderr
    assert '--node' in result.stderr


def test_mode_does_not_find_its_own_client():
    """Without a node, the error would advise a longer timeout instead of starting one."""
    result = cloth_sim('mode', 'adaptive', '--node', '/nobody/there', '--timeout', '2')
    assert result.returncode == 1
    assert 'busy' not in result.stderr and '--node' in result.stderr


def test_names_the_nodes_that_are_there(cloth):
    """A user of a node with a namespace would not learn its name."""
    # How soon the node is found depends on what else the machine does.
    for seconds in ('2', '20', '200'):
        result = cloth_sim('pause', '--node', 'not_me', '--timeout', seconds)
        assert result.returncode == 1
        if cloth.name in result.stderr:
            break
    assert cloth.name in result.stderr


def test_says_how_to_get_ros():
    """A verb for a running node would end in a traceback on a machine without ROS."""
    result = cloth_sim('pause', before='import sys; sys.modules["rclpy"] = None')
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert 'source /opt/ros/jazzy/setup.bash' in result.stderr


def test_run_needs_no_ros(tmp_path):
    """A machine without ROS could not simulate at all."""
    scene = tmp_path / 'scene.yaml'
    scene.write_text('/**: {ros__parameters: {rows: 4, cols: 5}}')
    state = tmp_path / 'state.npz'
    result = cloth_sim(
        'run', str(scene), '--seconds', '0.02', '--out', str(state), before=(
            'import sys\n'
            'for name in ("rclpy", "cloth_sim_interfaces", "sensor_msgs", "rcl_interfaces"):\n'
            '    sys.modules[name] = None'))
    assert result.returncode == 0, result.stderr
    assert Path(state).exists()


@pytest.mark.parametrize('name', ['a b', 'a//b', '', '-', '~/a', '*'])
def test_refuses_what_is_no_name_of_a_node(name):
    """A mistyped name would end in a traceback of ROS."""
    result = cloth_sim('pause', f'--node={name}', '--timeout', '0.1')
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1, result.stderr
    assert f'{name!r} is not a node name: give the name' in result.stderr
