# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Data sets of labelled pictures of a cloth, reproducible from their seed."""
