# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is modelled, in NumPy alone: parameters, fabric, edges, bodies, and how they move."""
