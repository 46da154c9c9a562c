# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What ROS itself refuses when it is asked for a node, in one sentence."""

import os

from cloth_sim_ros.files.echo import cut
from cloth_sim_ros.sim.errors import ClothSimError


def ros_reason(error: Exception) -> str:
    """Return what ROS says in ``error``, without the line of its source."""
    text = str(error).partition(', at /')[0].removeprefix('failed to initialize rcl: ')
    return cut(' '.join(text.split()))


def is_about_security(error: Exception) -> bool:
    """Tell whether ROS lacks what a secured graph needs."""
    return 'SECURITY' in str(error).upper()


def no_node(error: Exception) -> ClothSimError:
    """Return the error to raise where ROS makes no node."""
    if os.environ.get('ROS_SECURITY_ENABLE', '').lower() == 'true':
        way_out = (
            'use a ROS built with security and name an enclave of ROS_SECURITY_KEYSTORE, with '
            '--ros-args --enclave or ROS_SECURITY_ENCLAVE_OVERRIDE, or unset ROS_SECURITY_ENABLE')
    else:
        way_out = 'check the ROS_ and RMW_ variables of the environment'
    return ClothSimError(f'ROS cannot create a node: {ros_reason(error)}; {way_out}')
