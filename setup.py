# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Build cloth_sim_ros as an ament_python package."""

from pathlib import Path

from setuptools import find_packages
from setuptools import setup

PACKAGE = 'cloth_sim_ros'
SHARED_FOLDERS = ('config', 'launch', 'shaders')


def shared_files():
    """List the files that go to share/, folder by folder."""
    folders = {}
    for top in SHARED_FOLDERS:
        for path in sorted(Path(top).rglob('*')):
            if path.is_file() and '__pycache__' not in path.parts:
                folders.setdefault(f'share/{PACKAGE}/{path.parent}', []).append(str(path))
    return sorted(folders.items())


setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    package_data={
        PACKAGE: ['py.typed', '*.pyi'], f'{PACKAGE}.study.paper': ['*.c', '*.csv']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        *shared_files(),
    ],
    python_requires='>=3.10',
    install_requires=['setuptools'],
    # By the second, colcon test knows that the tests are pytest's.
    extras_require={'gym': ['gymnasium'], 'test': ['pytest']},
    zip_safe=True,
    maintainer='cloth_sim_ros maintainers',
    maintainer_email='maintainers@users.noreply.h-seed-ecbf5628.example',
    description='Cloth simulation on GLSL compute shaders as a ROS 2 node.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'cloth_sim = cloth_sim_ros.verb.main:main',
            'cloth_sim_node = cloth_sim_ros.node.command:main',
        ],
    },
)
