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

"""Read a ROS parameter file into dotted names, without ROS."""

from collections.abc import Mapping
from pathlib import Path
import re
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
import yaml


class _RosLoader(yaml.SafeLoader):
    """Reads numbers as ROS does: 1e6 is one, which YAML 1.1 takes for a word."""


_RosLoader.add_implicit_resolver(
    'tag:yaml.org,2002:float',
    re.compile(r'^[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$'), list('-+.0123456789'))


def parse_value(text: str) -> Any:
    """Return the value ``text`` has in a parameter file; yaml.YAMLError when it has none."""
    return yaml.load(text, Loader=_RosLoader)


def load_yaml(path: str | Path) -> Any:
    """Return what the YAML file at ``path`` holds; ClothSimError when it can't be read."""
    try:
        return parse_value(Path(path).read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError) as error:
        raise ClothSimError(f'{path} cannot be read: {error}') from error
    except yaml.YAMLError as error:
        raise ClothSimError(f'{path} is not valid YAML: {error}') from error


def load_parameters(path: str | Path) -> dict[str, Any]:
    """
    Return the parameters of a ROS parameter YAML as dotted names and values.

    Every node section of the file is taken, later ones over earlier ones.

    :raises ClothSimError: when the file can't be read or is no parameter file
    """
    document = load_yaml(path)
    if not isinstance(document, Mapping):
        raise ClothSimError(f'{path} holds no parameters: write "/**: {{ros__parameters: ...}}"')
    parameters: dict[str, Any] = {}
    for section in document.values():
        if not isinstance(section, Mapping) or not isinstance(
                section.get('ros__parameters'), Mapping):
            raise ClothSimError(
                f'{path} has a section without ros__parameters: '
                'write "/**: {ros__parameters: ...}"')
        _flatten(section['ros__parameters'], '', parameters)
    return parameters


def _flatten(tree: Mapping[str, Any], prefix: str, into: dict[str, Any]) -> None:
    for key, value in tree.items():
        if isinstance(value, Mapping):
            _flatten(value, f'{prefix}{key}.', into)
        else:
            into[f'{prefix}{key}'] = value
