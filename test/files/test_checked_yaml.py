# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""YAML that may be hostile."""

import math

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.checked_yaml import MOST_BYTES
from cloth_sim_ros.files.checked_yaml import MOST_DEPTH
from cloth_sim_ros.files.checked_yaml import parse_yaml
from cloth_sim_ros.files.errors import ClothSimError
import pytest


@pytest.mark.parametrize(('text', 'value'), [
    ('1e6', 1e6), ('1.0e6', 1e6), ('-2.5E-3', -2.5e-3), ('3', 3), ('0.5', 0.5), ('true', True),
    ('[1e2, 2.0]', [100.0, 2.0]), ('top_edge', 'top_edge'), ("'1e6'", '1e6'), ('-0', 0),
    ('010', 8), ('0x1F', 31), ('-0x1f', -31), ('09', 9.0), ('+7', 7), ('.5', 0.5), ('5.', 5.0),
    ('.inf', math.inf), ('-.INF', -math.inf), ('No', False), ('~', None), ('', None),
    ('2001-99-99', '2001-99-99'), ('2001-01-01', '2001-01-01'), ('0x_', '0x_'), ('1_0', '1_0'),
    ('1:30', '1:30'), ('=', '='), ('<<', '<<'), ('!!str 3', '3'), ('!!int 3', 3), ('! 3', '3'),
    ('!!float 3', 3.0), ('!!bool yes', True), ('!!seq [1]', [1]), ('!!map {a: 1}', {'a': 1}),
    ('{a: &x [1, 2], b: *x}', {'a': [1, 2], 'b': [1, 2]}), ('[&x 1, *x]', [1, 1])])
def test_values_have_the_types_that_ros_gives_them(text, value):
    """A stiffness of 1e6 would be a number to the node and a word to `cloth_sim run`."""
    assert parse_yaml(text, 'it') == value
    assert type(parse_yaml(text, 'it')) is type(value)


@pytest.mark.parametrize(('text', 'rule'), [
    ('!!int "abc"', "'abc' where !!int requires another type"),
    ('!!bool "abc"', "'abc' where !!bool"), ('!!int ""', "'' where !!int"),
    ('!!timestamp 2001-01-01', 'ROS has no type'), ('!!binary aGk=', 'ROS has no type'),
    ('!!set {a, b}', 'ROS has no type'), ('!!omap [a: 1]', 'ROS has no type'),
    ('!!python/object/apply:os.system [ls]', 'ROS has no type'),
    ('!mine 3', 'ROS has no type'),
    ('9' * 5000, 'a number of 5000 characters'), ('0x' + 'f' * 5000, 'a number of 5002'),
    ('1.' + '0' * 5000, 'a number of 5002'), ('[' * 1000, f'more than {MOST_DEPTH} nested lists'),
    ('{a: ' * 1000, f'more than {MOST_DEPTH} nested lists'),
    ('- ' * 1000, f'more than {MOST_DEPTH}'),
    ('? ' * 1000, f'more than {MOST_DEPTH}'), ('&b {x: *b}', r'\*b within &b'),
    ('[&a [*a]]', r'\*a within &a'), ('*a', r'\*a without &a'),
    ('{a: 1, b: 2, a: 3}', 'the key a twice'), ('a: 1\nb: 2\na: 3', 'twice, again in line 3'),
    ('{1: 2, 0x1: 3}', 'the key 1 twice'), ('{[a]: 1}', 'as a key'), ('? {a: 1}\n: 2', 'as a key'),
    ('a: 1\n---\nb: 2', 'a second document in line 2'), ('a: [1, 2', 'not valid YAML'),
    ('\x00', 'not valid YAML'), ('a: \ud800', 'not valid YAML'), ('%TAG x', 'not valid YAML'),
    ('\x1b[2J', 'not valid YAML')], ids=lambda each: each[:20])
def test_what_is_not_taken_is_refused_in_one_sentence(text, rule):
    """A user would get a traceback, a hang, or one of two values without a word."""
    with pytest.raises(ClothSimError, match=rule) as error:
        parse_yaml(text, 'the file')
    assert str(error.value).startswith('the file ')
    assert len(str(error.value).splitlines()) == 1 and len(str(error.value)) < 500


def test_aliases_do_not_multiply():
    """A few lines would stand for ten billion values."""
    lines = ['a0: &a0 [x, x, x, x, x, x, x, x, x, x]']
    for number in range(1, 11):
        repeated = ', '.join([f'*a{number - 1}'] * 10)
        lines.append(f'a{number}: &a{number} [{repeated}]')
    with pytest.raises(ClothSimError, match='with aliases expanded'):
        parse_yaml('\n'.join(lines), 'the file')


def test_aliases_do_not_nest():
    """Whoever walks through the value would need as many calls in one another."""
    lines = ['a0: &a0 [x]'] + [f'a{i}: &a{i} [*a{i - 1}]' for i in range(1, 2 * MOST_DEPTH)]
    with pytest.raises(ClothSimError, match=f'more than {MOST_DEPTH} nested lists and mappings'):
        parse_yaml('\n'.join(lines), 'the file')


def test_a_hundred_thousand_brackets_are_refused():
    """The process would end by a signal, without a word."""
    for text in ('[' * 100_000, '{a: ' * 100_000, '- ' * 100_000, '[' * 100_000 + ']' * 100_000):
        with pytest.raises(ClothSimError, match='nested lists and mappings in line 1'):
            parse_yaml(text, 'the file')


def test_files_are_read_and_refused_by_name(tmp_path):
    """A user would not know which of several files is wrong."""
    file = tmp_path / 'file.yaml'
    file.write_text('a: [1, ä]')
    assert load_yaml(file) == {'a': [1, 'ä']}
    for content, rule in (
            (b'a: \xff', 'byte 3 is not UTF-8'), (b' ' * (MOST_BYTES + 1), 'the limit'),
            (b'a: 1\na: 2', 'the key a twice')):
        file.write_bytes(content)
        with pytest.raises(ClothSimError, match=rf'file\.yaml .*{rule}'):
            load_yaml(file)
    for path in (tmp_path / 'none.yaml', tmp_path / ('x' * 5000), tmp_path / 'a\x00b'):
        with pytest.raises(ClothSimError, match='cannot be read'):
            load_yaml(path)
