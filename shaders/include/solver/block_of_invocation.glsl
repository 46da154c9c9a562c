// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Which block of a lattice with cols nodes in a row is this invocation's, x and y.
// BLOCKS_IN_LINE: count them row by row. Software runs 8 invocations of a row at a time, which
// leaves many idle where a row has, say, 9.

ivec2 block_of_invocation(int cols) {
#if BLOCKS_IN_LINE
    int at = int(gl_WorkGroupID.x * (LOCAL_X * LOCAL_Y) + gl_LocalInvocationIndex);
    int across = (cols + BLOCK - 1) / BLOCK;
    return ivec2(at % across, at / across);
#else
    return ivec2(gl_GlobalInvocationID.xy);
#endif
}
