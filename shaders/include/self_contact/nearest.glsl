// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The nearest points of a point and a triangle, and of two segments (C. Ericson, Real-Time Collision
// Detection, 2005, sections 5.1.5 and 5.1.9), and the place in the triangle that is nearest.

#define AT_A 0
#define AT_B 1
#define AT_C 2
#define ON_AB 3
#define ON_BC 4
#define ON_AC 5
#define INSIDE 6

// Weights of the corners of the point of a triangle that is nearest to the origin.
vec3 nearest_in_triangle(vec3 a, vec3 b, vec3 c, out int place) {
    vec3 ab = b - a, ac = c - a;
    float d1 = -dot(ab, a), d2 = -dot(ac, a);
    float d3 = -dot(ab, b), d4 = -dot(ac, b);
    float d5 = -dot(ab, c), d6 = -dot(ac, c);
    float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    float along_bc = d4 - d3, against_bc = d5 - d6;
    if (d1 <= 0.0 && d2 <= 0.0) {
        place = AT_A;
        return vec3(1.0, 0.0, 0.0);
    }
    if (d3 >= 0.0 && d4 <= d3) {
        place = AT_B;
        return vec3(0.0, 1.0, 0.0);
    }
    if (d6 >= 0.0 && d5 <= d6) {
        place = AT_C;
        return vec3(0.0, 0.0, 1.0);
    }
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        place = ON_AB;
        float v = d1 / (d1 - d3);
        return vec3(1.0 - v, v, 0.0);
    }
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        place = ON_AC;
        float w = d2 / (d2 - d6);
        return vec3(1.0 - w, 0.0, w);
    }
    if (va <= 0.0 && along_bc >= 0.0 && against_bc >= 0.0) {
        place = ON_BC;
        float w = along_bc / (along_bc + against_bc);
        return vec3(0.0, 1.0 - w, w);
    }
    place = INSIDE;
    float scale = 1.0 / (va + vb + vc);
    float v = vb * scale, w = vc * scale;
    return vec3(1.0 - v - w, v, w);
}

// Places along two segments from p by d and from q by e where they are nearest, and the square of
// the sine between them.
vec3 nearest_on_segments(vec3 p, vec3 d, vec3 q, vec3 e) {
    vec3 r = p - q;
    float a = dot(d, d), b = dot(d, e), c = dot(d, r), f = dot(e, e), g = dot(e, r);
    float across = max(a * f - b * b, 0.0);
    float square = across / max(a * f, 1e-30);
    float s = square > 1e-10 ? clamp((b * g - c * f) / across, 0.0, 1.0) : 0.0;
    float t = (b * s + g) / max(f, 1e-30);
    if (t < 0.0) {
        t = 0.0;
        s = clamp(-c / max(a, 1e-30), 0.0, 1.0);
    } else if (t > 1.0) {
        t = 1.0;
        s = clamp((b - c) / max(a, 1e-30), 0.0, 1.0);
    }
    return vec3(s, t, square);
}
