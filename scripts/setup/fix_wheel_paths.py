# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Point the cmake files of the ROS wheels at this Python and its NumPy.

The wheels' exported targets name the include folders of the machine that built them.
Run by the Python of the prefix to correct; running it again changes nothing.
"""

from pathlib import Path
import re
import sys
import sysconfig

import numpy

BUILD_PREFIX = r'/opt/(?:python|_internal)/[^;" )\n]*'
NUMPY_INCLUDE = re.compile(BUILD_PREFIX + r'/numpy/_?core/include')
PYTHON_INCLUDE = re.compile(BUILD_PREFIX + r'/include/python3\.\d+t?')
LEFT_OVER = re.compile(BUILD_PREFIX)


def corrected(text: str, python_include: str, numpy_include: str) -> str:
    """Replace the include folders of the build machine."""
    text = NUMPY_INCLUDE.sub(lambda _: numpy_include, text)
    return PYTHON_INCLUDE.sub(lambda _: python_include, text)


def mend_prefix(prefix: Path, python_include: str, numpy_include: str) -> tuple[int, set[str]]:
    """Correct every cmake file under the prefix; return the count and the files that failed."""
    changed = 0
    left_over: set[str] = set()
    for path in sorted((prefix / 'share').rglob('*.cmake')):
        old = path.read_text(encoding='utf-8')
        new = corrected(old, python_include, numpy_include)
        left_over.update(LEFT_OVER.findall(new))
        if new != old:
            path.write_text(new, encoding='utf-8')
            changed += 1
    return changed, left_over


def main() -> str | None:
    """Mend the prefix of the running Python."""
    _, left_over = mend_prefix(
        Path(sys.prefix), sysconfig.get_paths()['include'], numpy.get_include())
    if left_over:
        return ('the ROS wheels name folders of their build machine that this machine lacks: '
                f'{sorted(left_over)}: update PYTHON_INCLUDE and NUMPY_INCLUDE in {__file__}')
    return None


if __name__ == '__main__':
    sys.exit(main())
