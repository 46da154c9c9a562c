# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contenders are timed in turn, and what cannot be run says why."""

from dataclasses import replace
from functools import cache
import json
import statistics

from cloth_sim_ros.gl.context import is_software
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.paper.cloths import PaperCloth
from cloth_sim_ros.study.paper.cloths import square
from cloth_sim_ros.study.paper.cloths import TWO_FAMILIES
from cloth_sim_ros.study.paper.contenders import CONTENDERS
from cloth_sim_ros.study.paper.plot import write_plot
from cloth_sim_ros.study.paper.printed import printed_speeds
from cloth_sim_ros.study.paper.table import growth_line
from cloth_sim_ros.study.paper.table import real_time_line
from cloth_sim_ros.study.paper.table import table_rows
from cloth_sim_ros.study.paper.timing import growths
from cloth_sim_ros.study.paper.timing import Speed
from cloth_sim_ros.study.paper.timing import time_alone
from cloth_sim_ros.study.paper.timing import time_cloth
from cloth_sim_ros.study.paper.timing import TimedCloth
from PIL import Image
import pytest

SHORT = {'rounds': 2, 'turn_seconds': 1e-3, 'row_seconds': 60.0}


def made(nodes, rates, method='constraint', families=('structural', 'shear', 'bend')):
    """Return a cloth with rates that were not measured, by contender."""
    printed = next((
        speed for speed in printed_speeds() if (speed.method, speed.nodes) == (method, nodes)),
        None)
    return TimedCloth(method, nodes, 6 * nodes, families, printed, 'device', '0', tuple(
        Speed(name, 'serial' in name, fps, (fps, fps)) if fps else
        Speed(name, False, reason='it is too large')
        for name, fps in rates.items()))


@cache
def timed_square(method):
    """Return what the contenders take on a cloth of 9 x 9 nodes."""
    return time_cloth(square(method, 9), **SHORT)


@pytest.mark.parametrize('method', CONTENDERS)
def test_all_are_timed_with_their_ratios(method):
    """A program would be left out, or compared with another round than its own."""
    timed = timed_square(method)
    assert timed.device and timed.nodes == 81
    names = [each.name for each in CONTENDERS[method]]
    assert [speed.contender for speed in timed.speeds] == names
    paper, *others = timed.speeds
    assert paper.is_serial and paper.ratios == (1.0, 1.0)
    for speed in others:
        assert speed.fps == statistics.median(speed.rounds) > 0.0
        assert speed.ratios == pytest.approx(
            [own / other for own, other in zip(speed.rounds, paper.rounds, strict=True)])
    if method == 'mass_spring':
        assert not any(speed.plain_ratios for speed in timed.speeds)
    else:
        plain = timed.speeds[1]
        assert plain.is_serial and plain.plain_ratios == (1.0, 1.0)
        assert timed.speeds[-1].plain_ratios == pytest.approx([
            own / other for own, other in zip(timed.speeds[-1].rounds, plain.rounds)])
    assert json.loads(json.dumps(timed.as_dict()))['speeds'][0]['contender'] == names[0]


def test_the_details_say_what_was_solved():
    """A rate would stand for an unknown number of constraints and iterations."""
    paper, plain, shaders, *_ = timed_square('constraint').speeds
    for speed in (paper, plain):
        assert f'{PaperCloth("constraint", 9, 9).springs} constraints' in speed.detail
    for speed in (paper, plain, shaders):
        assert 'iterations' in speed.detail


def test_what_is_sure_to_take_too_long_is_not_run():
    """A table would take hours for the matrix of one cloth."""
    timed = time_cloth(square('constraint', 14), **{**SHORT, 'row_seconds': 1e-3})
    reasons = [speed.reason for speed in timed.speeds]
    assert '1,038 x 1,038 pairs' in reasons[0]
    # A GPU looks at them at the same time.
    assert ('1,038 x 1,038 pairs' in reasons[2]) == is_software(timed.device)
    assert not reasons[1] and not reasons[3]
    # What takes long for the bound has its first step alone, as a figure without a range.
    assert all(len(speed.rounds) == 1 for speed in timed.speeds if not speed.reason)
    assert all(len(speed.plain_ratios) == 1 for speed in timed.speeds if not speed.reason)
    assert not any(speed.ratios for speed in timed.speeds)


def test_a_cloth_that_the_device_cannot_hold_says_so(monkeypatch):
    """One cloth that is too large would end the whole table."""
    def refuse(*_):
        raise ClothSimError('the device has buffers of 128 MiB at most')

    monkeypatch.setattr(PaperCloth, 'start', refuse)
    timed = time_cloth(square('mass_spring', 9), **SHORT)
    assert {speed.reason for speed in timed.speeds} == {
        'the device has buffers of 128 MiB at most'}
    assert 'not run' in table_rows(timed) and 'none here' in real_time_line(timed)


def test_a_process_of_its_own_finds_the_same_programs():
    """Each cloth would be timed with the worker threads of the first one."""
    timed = time_alone(square('mass_spring', 6), **{**SHORT, 'rounds': 1})
    assert [speed.contender for speed in timed.speeds] == [
        each.name for each in CONTENDERS['mass_spring']]
    assert timed.threads == '0'


def test_growth_is_fitted_over_cloths_of_one_kind():
    """An exponent would mix cloths with and without bend edges, or printed limits with rates."""
    cloths = [made(nodes, {'serial': 1e6 / nodes**2}) for nodes in (144, 256, 400)]
    cloths += [made(nodes, {'serial': 1e3 / nodes}, families=TWO_FAMILIES)
               for nodes in (144, 2704)]
    found = growths(cloths[:3]) | growths(cloths[3:])
    assert found['serial'].exponent == pytest.approx(2.0)
    assert found['serial, no bend edges'].exponent == pytest.approx(1.0)
    # Printed: 32, 10 and 4 fps; the square of the nodes gives 32, 10.1 and 4.1.
    assert found['printed CPU'].exponent == pytest.approx(2.0, abs=0.05)
    assert list(found)[0] == 'printed CPU'
    assert 'serial 2.00 ± 0.00' in growth_line(found)


def test_rows_have_what_is_printed_and_measured():
    """A reader would compare a rate with that of another cloth."""
    cloth = made(144, {"serial, the paper's matrix": 40.0, 'GLSL, defaults': None})
    cloth = replace(cloth, speeds=(
        replace(cloth.speeds[0], rounds=(30.0, 50.0), ratios=(1.0, 1.0)), cloth.speeds[1]))
    first, second = table_rows(cloth).splitlines()
    cells = [cell.strip() for cell in first.strip('|').split('|')]
    assert cells[:6] == [
        '144', '864', '32, 2787', '87', "serial, the paper's matrix", '40 (30 to 50)']
    assert 'not run' in second and 'it is too large' in second


def test_a_figure_is_an_image(tmp_path):
    """The verb would end without the picture."""
    cloths = [
        made(nodes, {"serial, the paper's matrix": 1e4 / nodes, 'GLSL, defaults': None})
        for nodes in (144, 400)]
    cloths.append(made(900, {"serial, the paper's matrix": 3.0}, families=TWO_FAMILIES))
    write_plot(tmp_path / 'figure.png', 'constraint', 'Fig. 8', cloths)
    assert Image.open(tmp_path / 'figure.png').size[0] > 800
    with pytest.raises(ClothSimError, match='another --plot'):
        write_plot(tmp_path / 'none' / 'figure.png', 'constraint', 'Fig. 8', cloths)
