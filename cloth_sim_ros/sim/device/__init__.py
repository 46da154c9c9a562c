# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a scene is laid out on the device: buffers, programs, and what reads them back."""
