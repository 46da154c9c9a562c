# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth of springs in other simulators, a file each; mass_spring_peers.py times them."""
