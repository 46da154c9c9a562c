# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was measured for a device is used for it, and for nothing else."""

import json
import os
from types import SimpleNamespace

from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.tuning import BUILT_IN
from cloth_sim_ros.sim.device.tuning import Choice
from cloth_sim_ros.sim.device.tuning import read_tuning
from cloth_sim_ros.sim.device.tuning import Tuning
from cloth_sim_ros.sim.device.tuning import tuning_path
from cloth_sim_ros.sim.device.tuning import VARIABLE
from cloth_sim_ros.sim.device.tuning import write_tuning
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import pytest
from springs import SPRINGS
from tuned_device import allow_tunings
from tuned_device import tune_device

GPU = ('a GPU (TM) / 7', '4.6 driver')
SMALL, LARGE = Choice('texture', 2), Choice('storage', 4)
UNTUNED = Choice('storage', 1)


def choice_of(driver: str = GPU[1], texels: int = 2**27, **values: object) -> Choice:
    """Return what a scene on the GPU has."""
    context = SimpleNamespace(
        device=GPU[0], version=driver, is_software=False, max_buffer_bytes=2**27,
        max_texture_texels=texels)
    return choose_layout(Scene(values), context).choice


@pytest.fixture
def tuned(monkeypatch, tmp_path):
    """Tune the GPU and return the file."""
    return tune_device(monkeypatch, tmp_path, *GPU, {16: SMALL, 32: SMALL, 128: LARGE})


@pytest.mark.parametrize(('rows', 'cols', 'choice'), [
    (1, 2, SMALL), (16, 16, SMALL), (20, 20, SMALL), (32, 32, SMALL), (8, 128, SMALL),
    (33, 33, UNTUNED), (127, 127, UNTUNED), (128, 128, LARGE), (1000, 1000, LARGE)])
def test_the_measured_sizes_next_to_a_cloth_count(tuned, rows, cols, choice):
    """A large cloth would be stepped as suits a small one, and slower than without a tuning."""
    assert choice_of(**SPRINGS, rows=rows, cols=cols) == choice


@pytest.mark.parametrize('values', [
    {'mode': 'constraint'}, {'mode': 'adaptive'}, {'bending.damping': 0.01}], ids=str)
def test_what_was_not_measured_keeps_the_built_in_choice(tuned, values):
    """A shader would be compiled as suits another one: some take ten seconds and run slowly."""
    assert choice_of(**values) == UNTUNED


@pytest.mark.parametrize(('values', 'choice'), [
    ({'block': 2}, Choice('storage', 2)), ({'loads': 'texture'}, Choice('texture', 1)),
    ({'layout': 'paper'}, UNTUNED)], ids=str)
def test_what_a_scene_sets_is_used(tuned, values, choice):
    """A scene could not choose for itself, nor be run again as it was."""
    assert choice_of(**values) == choice


@pytest.mark.parametrize('word', ['off', 'OFF', '0', 'no', 'false'])
def test_the_environment_switches_it_off(tuned, monkeypatch, word):
    """A tuning could be got rid of only by removing it, and tests would depend on the machine."""
    assert choice_of() == SMALL
    monkeypatch.setenv(VARIABLE, word)
    assert choice_of() == UNTUNED


def test_another_driver_is_another_device(tuned):
    """What an older driver was fast with would be used for ever."""
    assert choice_of(driver='4.6 newer driver') == UNTUNED


def test_what_does_not_fit_is_not_used(monkeypatch, tmp_path):
    """A cloth that the device can hold would be refused because of a tuning."""
    tune_device(monkeypatch, tmp_path, *GPU, {32: SMALL})
    assert choice_of(rows=300, cols=300, texels=2**16) == UNTUNED
    assert choice_of(texels=0) == UNTUNED


def test_a_tuning_replaces_the_one_before(tuned):
    """The user would have to find and remove a file to measure again."""
    write_tuning(Tuning(*GPU, {64: BUILT_IN}))
    assert read_tuning(*GPU) == Tuning(*GPU, {64: BUILT_IN})
    assert choice_of() == UNTUNED
    assert list(tuned.parent.iterdir()) == [tuned]


def changed(**changes: object) -> bytes:
    """Return a file that differs from a right one."""
    entry = {'rows': 32, 'loads': 'texture', 'block': 2}
    choices = [{**entry, **{name: changes.pop(name) for name in entry if name in changes}}]
    return json.dumps(
        {'device': GPU[0], 'driver': GPU[1], 'choices': choices, **changes}).encode()


@pytest.mark.parametrize('content', [
    b'', b'\xff\xfe\x00', b'{', b'[' * 20_000, b'[]', b'3', b'9' * 5000, b'{}', b' ' * 100_000,
    changed(device='another GPU'), changed(driver='older'), changed(device=3), changed(choices=[]),
    changed(choices={}), changed(choices=[3]), changed(choices=[{}] * 1000), changed(rows=0),
    changed(rows='32'), changed(rows=True), changed(rows=float('nan')), changed(loads='fast'),
    changed(loads=[]), changed(block=5), changed(block=-1), changed(block=None), changed(more=1),
    None], ids=lambda content: repr(content)[:60])
def test_a_file_that_is_no_tuning_is_warned_of(tuned, content):
    """A run would fail, or use what nobody measured, because of a file that it can do without."""
    tuned.unlink()
    if content is None:
        os.mkfifo(tuned)
    else:
        tuned.write_bytes(content)
    with pytest.raises(ClothSimError) as caught:
        read_tuning(*GPU)
    with pytest.warns(UserWarning) as told:
        assert choice_of() == UNTUNED
    message, = (str(each.message) for each in told)
    assert message == str(caught.value) and '\n' not in message and len(message) < 1500
    assert f'{tuned} is not the tuning of a GPU (TM) / 7 (' in message
    assert message.endswith(
        '): remove it, make it anew with `cloth_sim tune`, or set CLOTH_SIM_TUNING=off')


def test_a_right_file_is_not_warned_of(tuned, recwarn):
    """The test before this one would take any file for broken."""
    tuned.write_bytes(changed())
    assert choice_of() == SMALL
    assert not recwarn.list


@pytest.mark.parametrize('folder', ['', 'relative/folder'])
def test_the_cache_is_below_home_by_default(monkeypatch, tmp_path, folder):
    """Files would lie in whatever folder a run was started in."""
    monkeypatch.setenv('XDG_CACHE_HOME', folder)
    monkeypatch.setenv('HOME', str(tmp_path))
    path = tuning_path(*GPU)
    assert path.parent == tmp_path / '.cache' / 'cloth_sim_ros'
    assert path.name == 'tuning_a_GPU_TM_7_4_6_driver.json'


def test_without_a_home_nothing_is_kept(monkeypatch):
    """A container without a home could simulate nothing."""
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.delenv('XDG_CACHE_HOME', raising=False)
    monkeypatch.setenv('HOME', '~')
    assert choice_of() == UNTUNED
    with pytest.raises(ClothSimError, match='without a home: set XDG_CACHE_HOME'):
        write_tuning(Tuning(*GPU, {32: SMALL}))


def test_a_cache_that_cannot_be_written_is_named(monkeypatch, tmp_path):
    """A tuning would end in a traceback after all has been measured."""
    (tmp_path / 'file').touch()
    allow_tunings(monkeypatch, tmp_path / 'file')
    assert choice_of() == UNTUNED
    with pytest.raises(ClothSimError, match='cannot be written.*: free disk space, or set XDG_'):
        write_tuning(Tuning(*GPU, {32: SMALL}))
