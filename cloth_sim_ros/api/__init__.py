# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs without a node, for Python programs and for verbs: scene files, recording, making again."""
