# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures and videos of the cloth, drawn by OpenGL without a window."""
