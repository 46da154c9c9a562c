# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Run a recorded simulation again from its recording alone, and compare. Needs no ROS."""
