# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Files damaged at random, and texts made hostile at random."""

from random import Random
import re
import struct

_NUMBERS = (
    0, 1, -1, 2**31 - 1, 2**31, 2**32 - 1, 2**62, 2**63 - 1, 2**63, 2**64 - 1, 10**6, 8192)
_TEXTS = (
    '1e400', '-1e308', '.nan', '.inf', '99999999999999999999', '9' * 5000, '0x_', '2001-99-99',
    '!!int "abc"', '!!bool "abc"', '!!timestamp x', '!!binary =', '!!python/name:os.system',
    '&a {x: *a}', '*nothing', '{}', '[]', '[[]]', '~', "''", '"\\x00"', '"' + 'x' * 5000 + '"',
    '\t', '- - - -', '? x', '%TAG', '---', '...', '<<: *a', '[' * 1000, '{a: ' * 1000, '\x00',
    '1:30:59', '0o7', '1_0', '../../etc/passwd', '/dev/zero', '\udcff')


def mutate_bytes(data: bytes, random: Random) -> bytes:
    """Return ``data`` with one to three mistakes."""
    result = bytearray(data)
    for _ in range(random.randint(1, 3)):
        random.choice(_MISTAKES)(result, random)
    return bytes(result)


def mutate_text(text: str, random: Random) -> bytes:
    """Return ``text`` with one to three mistakes that its reader may trip over."""
    for _ in range(random.randint(1, 3)):
        kind = random.random()
        if kind < 0.35:
            text = _with(text, r'-?\d+(\.\d+)?', random)
        elif kind < 0.6:
            text = _with(text, r'(?<=: )[^\n]+', random)
        elif kind < 0.7:
            place = random.randrange(len(text) + 1)
            text = text[:place] + random.choice(_TEXTS) + text[place:]
        elif kind < 0.8:
            lines = text.splitlines(True) or ['']
            line = random.choice(lines)
            lines.insert(random.randrange(len(lines) + 1), line)
            text = ''.join(lines)
        else:
            data = mutate_bytes(text.encode(errors='surrogateescape'), random)
            text = data.decode(errors='surrogateescape')
    return text.encode(errors='surrogateescape')


def _with(text: str, pattern: str, random: Random) -> str:
    """Return ``text`` with another value in one of the places of ``pattern``."""
    places = list(re.finditer(pattern, text))
    if not places:
        return text
    place = random.choice(places)
    number = str(random.choice(_NUMBERS))
    value = random.choice((number, number + '.0', random.choice(_TEXTS), random.choice(_TEXTS)))
    return text[:place.start()] + value + text[place.end():]


def _span(data: bytearray, random: Random) -> tuple[int, int]:
    begin = random.randrange(len(data) + 1)
    return begin, min(len(data), begin + random.choice((1, 4, 8, 60, 1000, len(data))))


def _flip(data: bytearray, random: Random) -> None:
    for _ in range(random.choice((1, 1, 8, 100))):
        if data:
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)


def _truncate(data: bytearray, random: Random) -> None:
    del data[random.randrange(len(data) + 1):]


def _remove(data: bytearray, random: Random) -> None:
    begin, end = _span(data, random)
    del data[begin:end]


def _repeat(data: bytearray, random: Random) -> None:
    begin, end = _span(data, random)
    place = random.randrange(len(data) + 1)
    data[place:place] = data[begin:end]


def _zero(data: bytearray, random: Random) -> None:
    begin, end = _span(data, random)
    data[begin:end] = bytes(end - begin)


def _noise(data: bytearray, random: Random) -> None:
    begin, end = _span(data, random)
    data[begin:end] = random.randbytes(end - begin)


def _number(data: bytearray, random: Random) -> None:
    size = random.choice((2, 4, 8))
    number = random.choice(_NUMBERS) & ((1 << 8 * size) - 1)
    place = random.randrange(max(1, len(data) - size))
    data[place:place + size] = number.to_bytes(size, random.choice(('little', 'big')))


def _float(data: bytearray, random: Random) -> None:
    value = random.choice((float('nan'), float('inf'), -1e308, 1e300, 5e-324))
    place = random.randrange(max(1, len(data) - 8)) & ~3
    data[place:place + 8] = struct.pack('<d', value)


_MISTAKES = (
    _flip, _flip, _flip, _truncate, _remove, _repeat, _zero, _noise, _number, _number, _number,
    _float)
