# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Progress bars are for terminals: what is piped or logged gets none."""

import ast
import os
from pathlib import Path
import pty
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / 'bags' / 'example'
_COMMANDS = {
    'run': ('run', ROOT / 'config' / 'drape.yaml', '--seconds', '0.4', '--set', 'rows=8'),
    'resimulate': ('resimulate', EXAMPLE),
    'analyze': ('analyze', EXAMPLE, '--out', '{out}/analysis'),
    'render': ('render', EXAMPLE, '--video', '{out}/video.mp4', '--to', '0.2'),
}


_STUDY = """
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.workers import Workers
if __name__ == '__main__':
    runs = [Run('study_runs:sleep', {}, {'seconds': 0.1 * n}) for n in range(3)]
    with ResultsFolder('study') as results:
        make_runs(runs, results, Workers(1), title='test')
"""


def shown(arguments: tuple, folder: Path, *, on_terminal: bool) -> str:
    """Return what the command writes besides its result."""
    return written([sys.executable, '-m', 'cloth_sim_ros.verb'] + [
        str(argument).format(out=folder) for argument in arguments], on_terminal=on_terminal)


def written(command: list[str], *, on_terminal: bool, **options: object) -> str:
    """Return what ``command`` writes to stderr."""
    if not on_terminal:
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        # On a machine that has never run it, a line says that shaders are compiled.
        return '\n'.join(
            line for line in done.stderr.splitlines() if not line.startswith('compiling shaders'))
    ours, its = pty.openpty()
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=its, check=True, **options)
    os.close(its)
    text = b''
    try:
        while part := os.read(ours, 65536):
            text += part
    except OSError:
        pass  # Linux tells so that the other end is closed
    os.close(ours)
    return text.decode()


# That every bar is made as that of `run` is, test_every_bar_is_for_terminals_alone shows.
@pytest.mark.parametrize('arguments', [
    pytest.param(arguments, id=verb, marks=() if verb == 'run' else pytest.mark.long)
    for verb, arguments in _COMMANDS.items()])
def test_a_pipe_gets_no_bar(arguments: tuple, tmp_path: Path):
    """A log would be filled with a line a frame."""
    assert shown(arguments, tmp_path, on_terminal=False) == ''


def test_a_terminal_gets_a_bar(tmp_path: Path):
    """Somebody who waits would not know for how long."""
    assert '100%' in shown(_COMMANDS['run'], tmp_path, on_terminal=True)


def test_a_study_tells_how_long_the_rest_takes(tmp_path: Path):
    """Somebody who starts a study of hours would not learn that before it ends."""
    script = tmp_path / 'study.py'
    script.write_text(_STUDY)
    text = written(
        [sys.executable, str(script)], on_terminal=True, cwd=tmp_path,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)})
    assert '3/3' in text
    # In tens of seconds, as long as starting a process takes on this machine.
    assert re.search(r'about \d+ (s|min) left', text)


def test_every_bar_is_for_terminals_alone():
    """A verb that is not run here would write into pipes."""
    found = []
    for path in sorted((ROOT / 'cloth_sim_ros').rglob('*.py')):
        for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Call) and getattr(node.func, 'id', '') == 'tqdm':
                options = {keyword.arg: keyword.value for keyword in node.keywords}
                # Without a value tqdm looks whether it writes to a terminal.
                shown_there = ast.unparse(options.get('disable', ast.Constant(False))) == 'None'
                found.append((path.name, shown_there))
    assert len(found) >= 6
    assert all(shown_there for _, shown_there in found), found
