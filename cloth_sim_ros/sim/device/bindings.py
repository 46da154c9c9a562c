# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which buffer stands where for the shaders: numbers that stand once, for both sides."""

POSITION_IN = 0
VELOCITY_IN = 1
POSITION_OUT = 2
VELOCITY_OUT = 3
REGION_PUSHES = 4
AIR_OUT = 5
MOVED_PINS = 5
NEAR_BLOCKS = 5
FORCE = 5
MASS = 7
RECORDS = 5
PARTIAL_SUMS = 6
SOLVER_SUMS = 2
SOLVER_DISPATCHES = 3
SOLVER_VECTORS = 5
SOLVER_SYSTEM = 6
SOLVER_SCALARS = 7
SOLVER_TALLY = 3
TENSION = 5
AT_LIMIT = 7
CONTACTS = 7
LOW_PARTS = 8
HELD = 6
SOLVER_HELD = 7
HELD_SUMS = 2
HELD_OWN = 3
LIMIT_LISTS = 9
LIMIT_IMPULSES = 10
LIMIT_CHANGES = 11
LIMIT_TALLY = 12
LIMIT_IMPULSES_OUT = 14
LIMIT_PREVIOUS = 15
LIMIT_FIGURES = 16

DEFINES = {name: value for name, value in list(globals().items()) if name.isupper()}
