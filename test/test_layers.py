# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Hold the imports to the layers of the architecture: each room looks only at those below it."""

import ast
from graphlib import CycleError
from graphlib import TopologicalSorter
from pathlib import Path
import sys

PACKAGE = Path(__file__).resolve().parents[1] / 'cloth_sim_ros'

# Each room, and the other rooms it may import.
ROOMS = {
    'files': set(),
    'gl': set(),
    'sim': {'gl', 'files'},
    'reference': {'sim'},
    'camera': {'sim', 'gl', 'files'},
    'validation': {'reference', 'sim', 'gl', 'files'},
    'messages': {'camera', 'sim'},
    'recording': {'messages', 'sim', 'files'},
    'playback': {'recording', 'messages', 'sim', 'files'},
    'node': {'recording', 'messages', 'sim', 'gl', 'files'},
    'study': {'gym', 'camera', 'recording', 'messages', 'sim', 'gl', 'reference', 'files'},
    'dataset': {'study', 'camera', 'sim', 'gl', 'files'},
    'analysis': {'recording', 'messages', 'sim', 'files'},
    'rendering': {'analysis', 'recording', 'messages', 'camera', 'sim', 'gl', 'files'},
    'view': {'analysis', 'messages', 'camera', 'sim', 'files'},
    'view/ros': {'view', 'node', 'analysis', 'messages', 'sim', 'files'},
    'resimulation': {'analysis', 'recording', 'sim', 'files'},
    'gym': {'rendering', 'camera', 'sim', 'files'},
    'api': {'node', 'resimulation', 'analysis', 'recording', 'messages', 'sim', 'files'},
    'verb': {
        'validation', 'view', 'view/ros', 'api', 'node', 'dataset', 'study', 'resimulation',
        'rendering', 'analysis', 'recording', 'messages', 'reference', 'sim', 'gl', 'playback',
        'files'},
}

# These rooms must run where there is no ROS; they may import no more than this beside Python.
WITHOUT_ROS = ('files', 'gl', 'sim', 'camera', 'reference', 'gym', 'validation', 'view')
NUMERIC_MODULES = {'numpy', 'scipy', 'OpenGL', 'yaml'}
# What one room alone may import besides.
# viser brings msgspec and websockets. The shape of a cloth is an image or a polygon.
OWN_MODULES = {
    'sim': {'PIL', 'matplotlib'}, 'view': {'viser', 'msgspec', 'websockets'},
    'camera': {'PIL', 'matplotlib'}, 'validation': {'PIL'}, 'gym': {'gymnasium'}}

SOURCES = sorted(path for path in PACKAGE.rglob('*.py') if path.parent != PACKAGE)


def imported_modules(path: Path) -> set[str]:
    """Return the full names of all modules a file imports, wherever it does."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{path}: relative import'
            names.update(f'{node.module}.{alias.name}' for alias in node.names)
    return names


def room_of(path: Path) -> str:
    """Return the room a file stands in."""
    return room_at(path.relative_to(PACKAGE).parts)


def room_at(parts: tuple[str, ...]) -> str:
    """Return the innermost room on a way through the package."""
    inner = '/'.join(parts[:2])
    return inner if inner in ROOMS else parts[0]


def test_every_room_is_known():
    """A new folder would have no place in the layers."""
    assert {room_of(path) for path in SOURCES} <= set(ROOMS)


def test_imports_go_down_only():
    """A room would depend on one above it, and could no longer be used or tested alone."""
    offenders = []
    for path in SOURCES:
        room = room_of(path)
        used = {
            room_at(tuple(name.split('.')[1:])) for name in imported_modules(path)
            if name.startswith('cloth_sim_ros.')}
        offenders += [
            f'{path.relative_to(PACKAGE)}: {other}' for other in used - {room} - ROOMS[room]]
    assert offenders == []


def test_no_modules_import_each_other():
    """One of two files could not be understood, changed or imported without the other."""
    modules = {
        '.'.join(path.relative_to(PACKAGE.parent).with_suffix('').parts): path
        for path in SOURCES}
    used = {}
    for module, path in modules.items():
        names = imported_modules(path)
        names |= {name.rpartition('.')[0] for name in names}
        used[module] = (names & set(modules)) - {module}
    try:
        TopologicalSorter(used).prepare()
    except CycleError as error:
        circle = ' is imported by '.join(error.args[1])
        raise AssertionError(circle) from None


def test_no_ros_below_the_messages():
    """The simulation would not run on a machine without ROS."""
    offenders = []
    for path in SOURCES:
        if room_of(path) in WITHOUT_ROS:
            allowed = NUMERIC_MODULES | OWN_MODULES.get(room_of(path), set())
            outside = {name.partition('.')[0] for name in imported_modules(path)}
            outside -= sys.stdlib_module_names | {'cloth_sim_ros'} | allowed
            offenders += [f'{path.relative_to(PACKAGE)}: {name}' for name in outside]
    assert offenders == []
