// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// A pinhole camera. The first line of its picture is the first that is read back.

uniform vec3 eye;              // of the camera in the world [m]
uniform vec3 eye_rest;         // what the rounding to float32 took from it [m]
uniform vec3 optical_axes[3];  // right, down and forward in the world
uniform float pinhole[6];      // fx fy cx cy [pixel], near and far [m]
uniform mat4 picture_matrix;   // clip coordinates of points relative to the eye

vec3 from_eye(vec3 point) {
    return (point - eye) - eye_rest;
}

// A vector from the eye, in the optical frame.
vec3 in_camera(vec3 away) {
    return vec3(
        dot(optical_axes[0], away), dot(optical_axes[1], away), dot(optical_axes[2], away));
}

// What the depth buffer has for a depth [m].
float buffer_depth(float depth) {
    float near = pinhole[4], far = pinhole[5];
    return clamp(far * (depth - near) / (depth * (far - near)), 0.0, 1.0);
}
