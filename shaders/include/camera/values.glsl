// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Measured values of the surface in a pixel.

#define TOO_NEAR uintBitsToFloat(0xff800000u)  // minus infinity (REP 117)

uniform int label;
layout(location = 0) out float depth;
layout(location = 1) out uint body;
#ifdef HAS_NORMALS
layout(location = 2) out vec4 facing;  // unit normal in the optical frame, towards the camera
layout(location = 3) out vec4 facet;   // unit normal n and offset d of the plane n . X = d [m]
#endif

void write_values(vec3 seen, vec3 smooth_normal, vec3 flat_normal) {
    if (seen.z > pinhole[5]) {
        discard;
    }
    depth = seen.z < pinhole[4] ? TOO_NEAR : seen.z;
    body = uint(label);
#ifdef HAS_NORMALS
    facing = vec4(dot(smooth_normal, seen) > 0.0 ? -smooth_normal : smooth_normal, 0.0);
    facet = vec4(flat_normal, dot(flat_normal, seen));
#endif
}
