# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Message definitions in a recording, so that it can be read without the package."""

from functools import cache
from importlib.util import find_spec
import json
from pathlib import Path
import re

from ament_index_python.packages import get_package_share_directory
from cloth_sim_ros.sim.errors import ClothSimError


def share_folder(package: str) -> Path:
    """Return the share/ folder of ``package``, from the ament index or beside its Python code."""
    try:
        return Path(get_package_share_directory(package))
    except KeyError:
        pass
    except OSError as error:
        # Without a sourced ROS the index has no search path at all: an OSError without a number.
        if error.errno is not None:
            raise
    code = find_spec(package)
    for prefix in Path(code.origin).parents if code is not None and code.origin else ():
        folder = prefix / 'share' / package
        if folder.is_dir():
            return folder
    raise ClothSimError(
        f'the ROS package {package} has no share folder, from which recordings take its message '
        'definitions: install or build it, and source its setup')


_PRIMITIVES = {
    'bool', 'byte', 'char', 'float32', 'float64', 'int8', 'uint8', 'int16', 'uint16', 'int32',
    'uint32', 'int64', 'uint64', 'string', 'wstring'}
_FIELD_TYPE = re.compile(r'^\s*([a-zA-Z0-9_/]+)', re.MULTILINE)


@cache
def message_definition(type_name: str) -> str:
    """Return the text of ``type_name``, such as std_msgs/msg/Header, and of all it is made of."""
    package, name = _split(type_name)
    return _text_with_parts(package, name, set())


@cache
def type_hash(type_name: str) -> str:
    """Return the hash publishers of ``type_name`` announce."""
    package, name = _split(type_name)
    description = json.loads((share_folder(package) / 'msg' / f'{name}.json').read_text())
    return next(
        entry['hash_string'] for entry in description['type_hashes']
        if entry['type_name'] == f'{package}/msg/{name}')


def _split(type_name: str) -> tuple[str, str]:
    parts = type_name.split('/')
    return parts[0], parts[-1]


def _text_with_parts(package: str, name: str, seen: set[str]) -> str:
    """Return the text of one type, then of each type in it that is not in ``seen`` yet."""
    text = (share_folder(package) / 'msg' / f'{name}.msg').read_text()
    found = set(_FIELD_TYPE.findall(text)) - _PRIMITIVES
    result = text
    for part in sorted(part if '/' in part else f'{package}/{part}' for part in found):
        if part not in seen:
            seen.add(part)
            result += f'\n{"=" * 80}\nMSG: {part}\n' + _text_with_parts(*_split(part), seen)
    return result
