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


"""Drawing a recording from the command line."""

from pathlib import Path

from cloth_sim_ros.verb.main import main
from matplotlib.image import imread
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope='module')
def bag(tmp_path_factory):
    """Record a short run of the shipped scene, made small."""
    folder = tmp_path_factory.mktemp('bags')
    assert main([
        'run', str(ROOT / 'config' / 'drape.yaml'), '--seconds', '0.2', '--record', str(folder),
        '--set', 'rows=6', '--set', 'cols=7', '--set', 'recording.name=small']) == 0
    return folder / 'small'


def test_draws_a_recording(bag, tmp_path, capsys):
    """The command of the README would not make a picture."""
    file = tmp_path / 'cloth.png'
    assert main(['picture', str(bag), '--out', str(file)]) == 0
    assert capsys.readouterr().out.strip() == str(file)
    assert imread(file).shape[0] > 200


def test_draws_the_times_and_the_view_asked_for(bag, tmp_path):
    """The picture would have other panels than asked for, or another camera."""
    one, two, turned = (tmp_path / f'{name}.png' for name in ('one', 'two', 'turned'))
    assert main(['picture', str(bag), '--out', str(one), '--at', '0.1']) == 0
    assert main(['picture', str(bag), '--out', str(two), '--at', '0.1,0.2']) == 0
    assert main(['picture', str(bag), '--out', str(turned), '--at', '0.1', '--view', '0', '90',
                 '--title', 'from above']) == 0
    assert imread(two).shape[1] > 1.3 * imread(one).shape[1]
    assert imread(turned).shape != imread(one).shape


@pytest.mark.parametrize('times', ['soon', '0.1,,0.2', 'nan', ''])
def test_refuses_times_that_are_none(bag, tmp_path, capsys, times):
    """A mistyped time would be drawn as another one."""
    file = tmp_path / 'cloth.png'
    with pytest.raises(SystemExit) as stop:
        main(['picture', str(bag), '--out', str(file), '--at', times])
    assert stop.value.code == 2
    assert 'write them as in 0.5,1,2' in capsys.readouterr().err
    assert not file.exists()


def test_says_what_is_wrong_with_a_recording(tmp_path, capsys):
    """A wrong path would end in a traceback."""
    assert main(['picture', str(tmp_path / 'none'), '--out', str(tmp_path / 'cloth.png')]) == 1
    assert 'there is no recording' in capsys.readouterr().err
