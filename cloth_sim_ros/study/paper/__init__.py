# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The speeds that the paper prints, and the same cloths timed on this machine."""
