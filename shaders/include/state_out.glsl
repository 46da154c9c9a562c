// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The state after the step, in the other pair of buffers.

layout(std430, binding = POSITION_OUT) writeonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) writeonly buffer VelocityOut { vec4 velocity_out[]; };
