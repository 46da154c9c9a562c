# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""cloth_sim status."""

import json
import os
import subprocess
import sys

from cloth_sim_interfaces.srv import Step


def test_prints_state_and_stats(verb, cloth):
    """A user could not see what the node is doing."""
    cloth.call(Step, 'step', steps=40)
    result = verb('status')
    assert result.returncode == 0, result.stderr
    lines = dict(
        (*line.split(maxsplit=1), '')[:2] for line in result.stdout.splitlines())
    assert lines['run_state'] == 'paused'
    assert lines['sim_time'] == '0.2'
    assert lines['rows'] == '8'
    assert (lines['time_source'], lines['epoch']) == ('own', '0.000')


def test_waits_for_a_simulated_time(verb, cloth):
    """A script would have to guess how long that takes on this machine."""
    assert verb('resume').returncode == 0
    result = verb('status', '--until', '0.5', '--json')
    assert verb('pause').returncode == 0
    assert json.loads(result.stdout)['stats']['sim_time'] >= 0.5


def test_a_time_that_does_not_come_is_told(verb, cloth):
    """A script would wait for ever for a node that is paused."""
    result = verb('status', '--until', '1e9')
    assert result.returncode == 1
    assert 'the node is paused at 0 s and will not reach 1e+09 s' in result.stderr


def test_prints_json(verb, cloth):
    """A script could not read the status."""
    cloth.call(Step, 'step', steps=40)
    content = json.loads(verb('status', '--json').stdout)
    assert content['state']['run_state'] == 'paused'
    assert 'mass_spring' in content['state']['available_modes']
    assert content['stats']['steps'] == 40


def test_middleware_output_is_not_in_the_answer(cloth, tmp_path):
    """A script would read an error of Fast DDS, which it prints to stdout, for the answer."""
    profiles = tmp_path / 'profiles.xml'
    profiles.write_text('<unfinished')
    done = subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'status', '--json', '--timeout', '120',
         '--node', cloth.name],
        capture_output=True, text=True,
        env={**os.environ, 'FASTRTPS_DEFAULT_PROFILES_FILE': str(profiles)})
    assert json.loads(done.stdout)['state']['run_state'] == 'paused'
    assert 'XMLPARSER' in done.stderr


def test_it_answers_where_stderr_is_closed(cloth):
    """A script that has closed stderr would get no answer."""
    done = subprocess.run(
        ['bash', '-c', 'exec "$@" 2>&-', 'bash', sys.executable, '-m', 'cloth_sim_ros.verb',
         'status', '--json', '--timeout', '120', '--node', cloth.name],
        stdout=subprocess.PIPE, text=True)
    assert done.returncode == 0
    assert json.loads(done.stdout)['state']['run_state'] == 'paused'
