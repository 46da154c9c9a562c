# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The door that every file of a user is read through: it may hold anything. Needs no ROS."""
