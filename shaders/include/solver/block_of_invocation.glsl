// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

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
