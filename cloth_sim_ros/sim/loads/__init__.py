# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What acts on the nodes besides edges and contact: gravity, pushes, air."""
