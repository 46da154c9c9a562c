# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which node a bag is of, by its topics and their types."""

from collections.abc import Iterable
from pathlib import Path

from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.sim.errors import ClothSimError

_OWN = 'cloth_sim_interfaces/msg/'

# The type of each topic behind the node's name: a recording is read without the interfaces.
TYPES = {
    'points': 'sensor_msgs/msg/PointCloud2',
    'markers': 'visualization_msgs/msg/MarkerArray',
    'topology': 'shape_msgs/msg/Mesh',
    'stats': f'{_OWN}ClothStats',
    'pins/wrenches': 'geometry_msgs/msg/WrenchStamped',
    'state': f'{_OWN}ClothState',
    'inputs/push': f'{_OWN}Push',
    'inputs/pin': f'{_OWN}PinChange',
    'inputs/pin_target': f'{_OWN}PinTarget',
    'inputs/wind': 'geometry_msgs/msg/Vector3Stamped',
    'inputs/mode': f'{_OWN}ModeChange',
    'inputs/command': f'{_OWN}Command',
    'inputs/parameters': 'rcl_interfaces/msg/ParameterEvent',
}


def find_node(topics: Iterable[BagTopic], path: Path) -> str:
    """
    Return the name of the one node that could have sent ``topics``, with its namespace.

    A topic of one of this project's types tells best; points alone count where there is none.

    :param path: of the bag, for the errors
    :raises ClothSimError: when there is none, or several
    """
    certain = set()
    possible = set()
    for topic in topics:
        for key, type_name in TYPES.items():
            node = topic.name.removesuffix(f'/{key}')
            if node == topic.name or type_name != topic.type_name:
                continue
            if type_name.startswith(_OWN):
                certain.add(node)
            elif key == 'points':
                possible.add(node)
    nodes = sorted(certain or possible)
    if not nodes:
        raise ClothSimError(
            f'{path} holds no frame of a cloth_sim node, as it has no topic like '
            '/cloth_sim/points or /cloth_sim/stats: give a recording of one')
    if len(nodes) > 1:
        raise ClothSimError(
            f'{path} holds several nodes ({", ".join(nodes)}): name one with --node')
    return nodes[0]
