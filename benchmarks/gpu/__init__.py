# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The sections of gpu_suite.py: checks and measurements of this package on a GPU."""
