// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Symmetric 3x3 matrices as (xx, yy, zz) and (xy, xz, yz), which add and scale like numbers.

#define Symmetric mat2x3

Symmetric outer_square(vec3 d) { return Symmetric(d * d, d.xxy * d.yzz); }

Symmetric scaled_identity(float scale) { return Symmetric(vec3(scale), vec3(0.0)); }

vec3 times(Symmetric s, vec3 v) {
    return s[0] * v
        + vec3(s[1].x * v.y + s[1].y * v.z, s[1].x * v.x + s[1].z * v.z,
               s[1].y * v.x + s[1].z * v.y);
}

// Inverse of s, whose eigenvalues are at least least. By elimination, since the formula with
// cofactors loses all digits where one direction is 1e4 times stiffer than the others.
Symmetric inverse_above(Symmetric s, float least) {
    float first = 1.0 / s[0].x;
    float yx = s[1].x * first;
    float zx = s[1].y * first;
    float second = 1.0 / max(s[0].y - yx * s[1].x, least);
    float rest = s[1].z - zx * s[1].x;
    float zy = rest * second;
    float third = 1.0 / max(s[0].z - zx * s[1].y - zy * rest, least);
    float back = yx * zy - zx;
    return Symmetric(
        vec3(first + yx * yx * second + back * back * third, second + zy * zy * third, third),
        vec3(-yx * second - back * zy * third, back * third, -zy * third));
}
