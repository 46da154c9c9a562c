# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Mend cmake files as the ROS wheels bring them."""

from importlib.util import module_from_spec
from importlib.util import spec_from_file_location
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[3] / 'scripts' / 'setup' / 'fix_wheel_paths.py'
EXPORT = (
    'set_target_properties(a PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "'
    '/opt/python/cp312-cp312/include/python3.12;'
    '/opt/_internal/cpython-3.12.11/include/python3.12;'
    '/opt/python/cp312-cp312/lib/python3.12/site-packages/numpy/_core/include;'
    '/opt/python/cp310-cp310/lib/python3.10/site-packages/numpy/core/include;'
    '${_IMPORT_PREFIX}/include")\n')

_spec = spec_from_file_location('fix_wheel_paths', SCRIPT)
fix_wheel_paths = module_from_spec(_spec)
_spec.loader.exec_module(fix_wheel_paths)


def test_build_paths_are_replaced(tmp_path):
    """cloth_sim_interfaces would not find Python.h or the headers of NumPy."""
    file = tmp_path / 'share' / 'a' / 'cmake' / 'export.cmake'
    file.parent.mkdir(parents=True)
    file.write_text(EXPORT)
    assert fix_wheel_paths.mend_prefix(tmp_path, '/py', '/np') == (1, set())
    assert '"/py;/py;/np;/np;${_IMPORT_PREFIX}/include"' in file.read_text()
    assert fix_wheel_paths.mend_prefix(tmp_path, '/py', '/np') == (0, set())


def test_what_cannot_be_mended_is_told(tmp_path):
    """A wheel with a new path would fail later, in the middle of a compiler's output."""
    file = tmp_path / 'share' / 'b.cmake'
    file.parent.mkdir()
    file.write_text('set(LIBRARY "/opt/python/cp312-cp312/lib/libpython.a")\n')
    _, left_over = fix_wheel_paths.mend_prefix(tmp_path, '/py', '/np')
    assert left_over == {'/opt/python/cp312-cp312/lib/libpython.a'}
