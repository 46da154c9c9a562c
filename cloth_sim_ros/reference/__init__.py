# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The oracle: the simulation's modes in float64 NumPy, slow and plain, no GL and no ROS."""
