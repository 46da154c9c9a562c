# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Speeds stand in docs/speed.md alone, which one command measures: pages can't contradict it."""

from pathlib import Path
import re

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / 'docs'
# Notes are journals of measurements, with commands and commits; the comparison is generated too.
EXCEPTED = (DOCS / 'speed.md', DOCS / 'comparison.md', DOCS / 'notes')
PAGES = [ROOT / 'README.md', *(
    page for page in sorted(DOCS.rglob('*.md'))
    if not any(page.is_relative_to(place) for place in EXCEPTED))]

_NUMBER = r'\d[\d.,]*'
_COUNT = rf'(?:{_NUMBER}|twice|three|four|five|six|seven|eight|nine|ten|a dozen|twenty)'
_TIME = rf'{_NUMBER} (?:us|ms|s|seconds?|minutes?)'
_OF_WHAT = r'(?:step|substep|frame|picture|sample|solve|iteration|pass|simulated second)'
SPEED = re.compile('|'.join((
    rf'{_NUMBER} x real[ -]time', rf'real-time factors?(?: of|:)? {_NUMBER}',
    rf'{_NUMBER} (?:(?:thousand|million|billion) )?(?:node steps|solves/s|steps/s|pictures/s)',
    rf'{_NUMBER} (?:steps|solves|pictures|frames) (?:per|a) second of (?:wall|processor|CPU)',
    # But a limit may be stated.
    rf'(?<!more than )(?<!within )\b{_TIME} of (?:a )?(?:processor|CPU)\b',
    rf'{_TIME} (?:per|a|for a|each) {_OF_WHAT}\b',
    rf'(?:takes?|took|in) (?:some |about |only |at most )?{_TIME}(?: to {_TIME})? '
    r'(?:on|with) (?:one|two|a|an|llvmpipe|the) ?(?:core|cores|GPU|H200)?',
    rf'{_COUNT} (?:times )?as (?:fast|long|slow|quick|quickly)\b',
    rf'{_COUNT} times (?:faster|slower|quicker)',
    rf'(?<!at least ){_NUMBER} % (?:faster|slower|less time|more time|of the time)',
    rf'{_NUMBER} of the (?:processor )?time\b',
    r'(?:in|takes?|took|costs?) (?:about |some )?(?:an? )?(?:half|third|quarter|tenth) of the '
    r'time\b',
    # In the head of a table; verbs have defaults.
    r'(?:processor|CPU|wall) time[^|]{0,60}\[(?:s|ms|us)\](?! \(default)',
    r'\bms a (?:sub)?step', r'(?:speed|time), relative',
    r'simulated time / (?:CPU|processor|wall) time')))


def speeds_in(text: str) -> list[str]:
    """Return the speeds in the prose of a page, outside of code, each with what is around it."""
    text = re.sub(r'^ *```.*?^ *```', '', text, flags=re.MULTILINE | re.DOTALL)
    # Indented by four: commands. What stands so in a list is indented by two.
    text = re.sub(r'^ {4,}.*$', '', text, flags=re.MULTILINE)
    text = ' '.join(re.sub(r'`[^`]*`', '``', text).split())
    return [text[max(0, found.start() - 40):found.end() + 40] for found in SPEED.finditer(text)]


@pytest.mark.parametrize('page', PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_no_speed_but_in_its_page(page):
    """Two pages would say different things, and one of them be out of date."""
    found = speeds_in(page.read_text(encoding='utf-8'))
    assert not found, f'state it in words, and link docs/speed.md: {found}'


@pytest.mark.parametrize('text', [
    'The node runs at 0.2 x real time.', 'with a real-time factor of 0.78 and',
    'It makes 71 million node steps/s.', 'gives 7.0 million node\nsteps per second',
    'about 1,100 solves/s', 'some 5 s of processor time a sample', '0.6 ms a substep with',
    'It takes 2.1 s of a processor.', 'in 7.3 ms per frame', 'A batch is 1.8 times as fast.',
    'takes four times as long', 'twice as fast as', 'is 31 times faster than',
    'costs 12 % less time',
    'in 0.7 of the time', 'in a quarter of the time', '| nodes | processor time of a step [ms] |',
    '| nodes | ms a substep |', '| run | time, relative |'])
def test_a_speed_is_found(text):
    """A pattern that finds nothing would let everything pass."""
    assert speeds_in(f'Before.\n\n{text}\n')


@pytest.mark.parametrize('text', [
    '```text\n0.943 x real time, below the target 1\n```', 'a warning `0.454 x real time`',
    '    cloth_sim run --rate 71 # 0.2 x real time', 'a dt of 20 ms in 34 substeps',
    'a pin moves at 0.3 m/s', 'four times the stiffness needs twice the substeps',
    'at least 3 % faster in every round', 'several times as fast', 'published once per second'])
def test_what_is_no_speed_may_stand(text):
    """Pages could not show the output of a command, or say why something is fast."""
    assert not speeds_in(f'Before.\n\n{text}\n')


def test_each_kind_of_page_is_looked_at():
    """A folder whose name has changed would be left out."""
    for place in ('README.md', 'docs/how_to', 'docs/reference', 'docs/explanation',
                  'docs/tutorial'):
        assert any(page.is_relative_to(ROOT / place) for page in PAGES)
