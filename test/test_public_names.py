# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The names that `import cloth_sim_ros` offers."""

import ast
from importlib.util import find_spec
import inspect
from pathlib import Path
import subprocess
import sys

import cloth_sim_ros
import pytest

HEAVY = ('OpenGL', 'mcap', 'matplotlib', 'numpy', 'rclpy', 'rosbags', 'scipy', 'yaml')


def public_members(value):
    """Yield name and object of what a class defines or inherits here and users may call."""
    for name, member in inspect.getmembers(value):
        function = member.fget if isinstance(member, property) else member
        function = getattr(function, 'func', function)  # of a cached_property
        if not name.startswith('_') and inspect.isroutine(function):
            if (getattr(function, '__module__', '') or '').startswith('cloth_sim_ros'):
                yield name, function


def documented_things():
    """Return what must have a docstring, by its dotted name."""
    found = {}
    for name in cloth_sim_ros.__all__:
        value = getattr(cloth_sim_ros, name)
        found[name] = value
        if inspect.isclass(value):
            found.update({
                f'{name}.{member}': function for member, function in public_members(value)})
    return found


def test_every_public_name_is_documented():
    """A user would have to read the source."""
    things = documented_things()
    assert len(things) > 80 and 'Simulation.mode' in things and 'Recording.arrays' in things
    assert [name for name, value in things.items() if not (value.__doc__ or '').strip()] == []


def test_arguments_and_results_have_types():
    """A type checker of a user's program would know nothing of a call."""
    untyped = []
    for name, value in documented_things().items():
        is_class = inspect.isclass(value)
        signature = inspect.signature(value.__init__ if is_class else value)
        missing = [
            parameter.name for parameter in signature.parameters.values()
            if parameter.annotation is parameter.empty
            and parameter.name not in ('self', 'cls', 'args', 'kwargs')]
        if not is_class and signature.return_annotation is signature.empty:
            missing.append('return')
        if missing:
            untyped.append(f'{name}: {missing}')
    assert untyped == []


def modules_after(program):
    """Return which of HEAVY are loaded in a process that has run ``program``."""
    report = f'import sys; print([name for name in {HEAVY} if name in sys.modules])'
    done = subprocess.run(
        [sys.executable, '-c', f'{program}\n{report}'], capture_output=True, text=True,
        check=True, timeout=300)
    return set(ast.literal_eval(done.stdout))


@pytest.mark.parametrize('program, needed', [
    ('import cloth_sim_ros', set()),
    ('from cloth_sim_ros import ClothSimError, DeviceError', set()),
    ('from cloth_sim_ros import Scene, Snapshot, load_scene', {'numpy', 'yaml'}),
    ('from cloth_sim_ros import Simulation', {'OpenGL', 'numpy', 'yaml'}),
    ('from cloth_sim_ros import Recording, resimulate',
     {'OpenGL', 'mcap', 'numpy', 'rosbags', 'yaml'})])
def test_a_name_imports_what_it_needs_alone(program, needed):
    """A program that reads a scene would wait for a GL driver, or fail where there is no ROS."""
    assert modules_after(program) <= needed


def test_a_name_that_is_not_there_is_an_ordinary_error():
    """`hasattr` and `from cloth_sim_ros import ...` would break in their own ways."""
    assert not hasattr(cloth_sim_ros, 'Cloth')
    assert set(cloth_sim_ros.__all__) <= set(dir(cloth_sim_ros))


def test_without_ros_the_recorder_says_how_to_get_it(tmp_path):
    """A user without ROS would get a bare ModuleNotFoundError."""
    program = (
        'import sys; sys.modules["rclpy"] = None\n'
        'from cloth_sim_ros import Simulation, Recording\n'
        'from cloth_sim_ros import SimulationRecorder')
    done = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, timeout=300)
    last = done.stderr.splitlines()[-1]
    assert last.startswith('ImportError: SimulationRecorder cannot be used: ROS 2 was not found')


def test_type_checkers_are_told_that_there_are_types():
    """A type checker would take the installed package for an untyped one."""
    package = Path(find_spec('cloth_sim_ros').origin).parent
    assert (package / 'py.typed').is_file()
    assert "['py.typed', '*.pyi']" in (package.parent / 'setup.py').read_text(encoding='utf-8')
    imports = [
        node for node in ast.parse((package / '__init__.pyi').read_text(encoding='utf-8')).body
        if isinstance(node, ast.ImportFrom)]
    assert {node.names[0].asname: node.module for node in imports} == {
        name: f'cloth_sim_ros.{module}' for name, module in cloth_sim_ros._MODULES.items()}
