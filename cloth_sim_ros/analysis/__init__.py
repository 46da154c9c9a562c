# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""What a recording says: frames, figures and pictures. Reads, and changes nothing."""
