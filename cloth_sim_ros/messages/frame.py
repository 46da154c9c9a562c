# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One frame: the cloth as an organised point cloud, and its plain numbers."""

import struct
from typing import Any

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.cdr_writer import ENCAPSULATION
from cloth_sim_ros.messages.stamp import STAMP
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.messages.stamp import STAMP_AT
from cloth_sim_ros.messages.stamp import stamp_parts
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2
from sensor_msgs.msg import PointField
from std_msgs.msg import Header

_LENGTH = struct.Struct('<I')
_MARK = bytes(range(64, 128))  # stands for the points when looking for their place

# How the types of ROS stand in a struct.
_CODES = {'double': 'd', 'uint64': 'Q', 'uint32': 'I', 'boolean': '?'}
_DATATYPES = {'<f4': PointField.FLOAT32, '<u4': PointField.UINT32}


class PointsMessage:
    """
    PointCloud2 of one cloth: everything but the stamp and the points is serialised once.

    :param frame_id: frame of the positions
    :param is_dense: False where some nodes are not there, whose values are NaN
    """

    def __init__(self, rows: int, cols: int, frame_id: str, *, is_dense: bool = True) -> None:
        """Serialise what stays the same from frame to frame."""
        self._shape = (rows, cols)
        self._is_dense = is_dense
        template = serialize_message(PointCloud2(
            header=Header(frame_id=frame_id),
            height=rows,
            width=cols,
            fields=[
                PointField(
                    name=name, offset=field[1], count=1, datatype=_DATATYPES[field[0].str])
                for name, field in (POINT_DTYPE.fields or {}).items()],
            is_bigendian=False,
            point_step=POINT_DTYPE.itemsize,
            row_step=POINT_DTYPE.itemsize * cols,
            data=_MARK,
            is_dense=True))
        place = template.index(_MARK)
        self._head = bytearray(template[:place])
        _LENGTH.pack_into(
            self._head, place - _LENGTH.size, rows * cols * POINT_DTYPE.itemsize)
        self._tail = bytearray(template[place + len(_MARK):])

    def serialise(self, snapshot: Snapshot, epoch: int = 0) -> bytes:
        """Return the CDR bytes of the PointCloud2 of ``snapshot``, stamped from ``epoch`` [ns]."""
        records = snapshot.records
        if records.shape != self._shape or records.dtype != POINT_DTYPE:
            raise ValueError(
                f'points are {records.shape} {records.dtype}, the message is {self._shape} '
                f'{POINT_DTYPE}: create a PointsMessage for this cloth')
        STAMP.pack_into(self._head, STAMP_AT, *stamp_parts(snapshot.time, epoch))
        self._tail[0] = self._is_dense and snapshot.finite  # is_dense, the last field
        return b''.join((self._head, np.ascontiguousarray(records).data, self._tail))


# One frame in plain numbers.


def stats_message(
        snapshot: Snapshot, frame_id: str, *, step_wall_time: float = 0.0,
        real_time_factor: float = 0.0, wanted_factor: float = 0.0,
        too_slow: bool = False) -> ClothStats:
    """
    Return the plain numbers of ``snapshot``.

    :param step_wall_time: wall time of one dt, mean over this frame [s]
    :param real_time_factor: simulated time per wall time, achieved
    :param wanted_factor: the same as requested, 0 for as fast as possible
    :param too_slow: True when the last second fell short of that
    """
    return ClothStats(
        header=Header(stamp=stamp(snapshot.time), frame_id=frame_id),
        **_stats(
            snapshot, step_wall_time, real_time_factor, wanted_factor, too_slow))


def _stats(
        snapshot: Snapshot, step_wall_time: float, real_time_factor: float, wanted_factor: float,
        too_slow: bool) -> dict[str, Any]:
    """Return the fields of the message but for its header, in their order."""
    return {
        'sim_time': float(snapshot.time),
        'steps': int(snapshot.steps),
        'dt': float(snapshot.dt),
        'substeps': int(snapshot.substeps),
        'stability_margin': float(snapshot.stability_margin),
        'kinetic_energy': float(snapshot.kinetic_energy),
        'elastic_energy': float(snapshot.elastic_energy),
        'gravitational_energy': float(snapshot.gravitational_energy),
        'total_energy': float(snapshot.total_energy),
        'max_strain': float(snapshot.max_strain),
        'solver_iterations': int(snapshot.solver_iterations),
        'solver_residual': float(snapshot.solver_residual),
        'solver_reached': bool(snapshot.solver_reached),
        'active_constraints': int(snapshot.active_constraints),
        'active_fraction': float(snapshot.active_fraction),
        'constraint_switches': int(snapshot.constraint_switches),
        'calm_substeps': int(snapshot.calm_substeps),
        'listed_substeps': int(snapshot.listed_substeps),
        'whole_substeps': int(snapshot.whole_substeps),
        'listed_edges': int(snapshot.listed_edges),
        'limit_rounds': int(snapshot.limit_rounds),
        'limit_unreached': int(snapshot.limit_unreached),
        'strain_over_bound': float(snapshot.strain_over_bound),
        'lengths_are_held': bool(snapshot.lengths_are_held),
        'settling': bool(snapshot.settling),
        'settling_work': float(snapshot.settling_work),
        'stalled_pins': int(snapshot.stalled_pins),
        'air_margin': float(snapshot.air_margin),
        'sticking_nodes': int(snapshot.sticking_nodes),
        'sliding_nodes': int(snapshot.sliding_nodes),
        'deepest_node': float(snapshot.deepest_node),
        'self_contacts': int(snapshot.self_contacts),
        'layer_overlap': float(snapshot.layer_overlap),
        'cut_nodes': int(snapshot.cut_nodes),
        'largest_cut': float(snapshot.largest_cut),
        'halved_substeps': int(snapshot.halved_substeps),
        'surface_contact_held': bool(snapshot.surface_contact_held),
        'step_wall_time': float(step_wall_time),
        'real_time_factor': float(real_time_factor),
        'real_time_factor_wanted': float(wanted_factor),
        'too_slow': bool(too_slow),
    }


class StatsMessage:
    """
    The same in the bytes that go out: an object of ROS checks each of its fields.

    :param frame_id: of the header
    """

    def __init__(self, frame_id: str) -> None:
        """Serialise the header, and find the place of every field."""
        self._head = bytearray(serialize_message(Header(frame_id=frame_id)))
        layout, size = '<', len(self._head) - len(ENCAPSULATION)
        for kind in list(ClothStats.get_fields_and_field_types().values())[1:]:
            code = _CODES[kind]
            padding = -size % struct.calcsize(code)
            layout += f'{padding}x{code}'
            size += padding + struct.calcsize(code)
        self._fields = struct.Struct(layout)

    def serialise(
            self, snapshot: Snapshot, *, step_wall_time: float, real_time_factor: float,
            wanted_factor: float, too_slow: bool, epoch: int = 0) -> bytes:
        """Return the CDR bytes of what ``stats_message`` returns, stamped from ``epoch`` [ns]."""
        STAMP.pack_into(self._head, STAMP_AT, *stamp_parts(snapshot.time, epoch))
        return bytes(self._head) + self._fields.pack(*_stats(
            snapshot, step_wall_time, real_time_factor, wanted_factor, too_slow).values())
