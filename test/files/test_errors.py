# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages repeat what was given, but no more than is needed to find it."""

from pathlib import Path
import re

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.scene import Scene
import pytest
from springs import SPRINGS

PACKAGE = Path(__file__).resolve().parents[2] / 'cloth_sim_ros'
FIELDS = SCENE_FIELDS + NODE_FIELDS
LONG = 1_000_000
MOST = 600


@pytest.mark.parametrize('value', ['fluid', '', 3, 2.5, None, [1.0, 2.0], ('a',), 'x' * 198, {}])
def test_what_is_short_is_shown_as_it_is(value):
    """A user would not recognise what was given."""
    assert shown(value) == repr(value)


@pytest.mark.parametrize('value', [
    'x' * LONG, '\x1b' * LONG, '\U0001f600' * LONG, 'x' * (MOST_SHOWN - 1), [1.0] * LONG,
    ['x' * LONG] * 10, {'a': 'x' * LONG}, 10**4000, 10**5000, b'\xff' * LONG, float('1e300')],
    ids=lambda value: type(value).__name__)
def test_what_is_long_is_cut(value):
    """A request could fill the log, and its response, with its own content."""
    text = shown(value)
    assert len(text) < MOST_SHOWN + 40
    assert len(text) <= MOST_SHOWN or '... (a length of ' in text


def test_a_cut_text_tells_how_long_it_was():
    """A user would take the part for the whole."""
    assert cut('x' * 200) == 'x' * 200
    assert cut('x' * 201) == 'x' * 200 + '... (a length of 201)'


def refusal(make):
    """Return the message of the error that ``make`` raises."""
    with pytest.raises(ClothSimError) as caught:
        make()
    return str(caught.value)


@pytest.mark.parametrize('value', [
    'x' * LONG, ['x' * LONG], [['x'] * LONG], 10**5000, [10**5000], {'a': 'x' * LONG}],
    ids=['word', 'words', 'list', 'number', 'numbers', 'group'])
def test_no_parameter_is_repeated_at_length(value):
    """A parameter file with a mistake would end in pages of it, or in a traceback."""
    offenders = []
    for field in FIELDS:
        try:
            field.check(value)
        except ClothSimError as error:
            if len(str(error)) >= MOST:
                offenders.append(f'{field.name}: {len(str(error))} characters')
        else:
            # Any word is right where there is no choice.
            if field.kind is not str or field.choices:
                offenders.append(f'{field.name}: taken')
    assert offenders == []


@pytest.mark.parametrize('make', [
    lambda: refuse_unknown({'x' * LONG: 1}, FIELDS),
    lambda: Scene({**SPRINGS, 'pins': ['x' * LONG]}).pinned_nodes(),
    lambda: Scene({**SPRINGS, 'pin_moves.start': [0.0], 'pin_moves.node': ['x' * LONG],
                   'pin_moves.target': [0.0, 0.0, 0.0]}).timed_pin_moves(),
    lambda: Push.checked(force=(1, 0, 0), start=0.0, duration=1.0, region='x' * LONG)])
def test_no_request_is_repeated_at_length(make):
    """A request could fill the log with its own content."""
    assert len(refusal(make)) < MOST


def test_every_message_is_cut():
    """A new message would repeat whatever it is given: only shown writes what was given."""
    raw = [
        f'{path.relative_to(PACKAGE)}:{number}'
        for path in sorted(PACKAGE.rglob('*.py')) if path != PACKAGE / 'files' / 'errors.py'
        for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), 1)
        if re.search(r'\{[^{}]+!r[:}]|\brepr\(|%r', line)]
    assert raw == []
