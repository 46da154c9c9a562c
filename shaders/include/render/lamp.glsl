// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Daylight on cloth, bodies and floor: a lamp that casts shadows, and light from the sky and the floor.

layout(binding = 2) uniform sampler2DShadow lamp_depths;
#ifdef LAMP_RIM_TAPS
layout(binding = 4) uniform sampler2DShadow nearest_depths;  // the same, without a mean of pixels
#endif
uniform mat4 lamp_matrix;    // clip coordinates of the lamp, for points as view_matrix has them
uniform vec3 lamp;           // unit vector to it
uniform float lamp_blur;     // radius of the soft edge of a shadow, over the depth texture's side
uniform float lamp_lift;     // the same radius [m]

float lamp_tap(vec3 at, float away, float angle) {
    return texture(lamp_depths, vec3(at.xy + away * vec2(cos(angle), sin(angle)), at.z));
}

// How much of the lamp a point sees, 0 to 1: the mean over a disc of LAMP_TAPS places.
float lamp_share(vec3 point) {
    vec3 at = 0.5 + 0.5 * (lamp_matrix * vec4(point, 1.0)).xyz;
    // Outside the lamp's picture nothing is in shadow; behind it, it may be.
    if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) {
        return 1.0;
    }
    at.z = min(at.z, 1.0);
#ifdef LAMP_RIM_TAPS
    // Where all of the rim is lit, or none of it, so is the disc.
    float rim = 0.0;
    for (int tap = 0; tap < LAMP_RIM_TAPS; ++tap) {
        float angle = 6.28318531 * float(tap) / float(LAMP_RIM_TAPS);
        rim += texture(
            nearest_depths, vec3(at.xy + lamp_blur * vec2(cos(angle), sin(angle)), at.z));
    }
    if (rim == 0.0 || rim == float(LAMP_RIM_TAPS)) {
        return rim / float(LAMP_RIM_TAPS);
    }
#endif
    float seen_taps = 0.0;
    for (int tap = 0; tap < LAMP_TAPS; ++tap) {
        // A sunflower spiral covers a disc evenly.
        seen_taps += lamp_tap(
            at, lamp_blur * sqrt((float(tap) + 0.5) / float(LAMP_TAPS)), 2.39996323 * float(tap));
    }
    return seen_taps / float(LAMP_TAPS);
}

// Colours are sums of light, so they are taken as such and not as a screen has them.
vec3 to_light(vec3 color) {
    return pow(color, vec3(2.2));
}

vec3 to_screen(vec3 light) {
    return pow(min(light, 1.0), vec3(1.0 / 2.2));
}

vec3 from_sky(vec3 outward) {
    return mix(vec3(FLOOR_LIGHT), vec3(SKY_LIGHT), 0.5 + 0.5 * outward.z);
}

// Light on an opaque surface.
vec3 daylight(vec3 color, vec3 point, vec3 outward) {
    float facing = max(dot(outward, lamp), 0.0);
    // Lifted off its own shadow by the width of the shadow's edge.
    float share = facing > 0.0 ? lamp_share(point + lamp_lift * (outward + lamp)) : 0.0;
    return to_screen(to_light(color) * (from_sky(outward) + LAMP_LIGHT * facing * share));
}

// Light on cloth, which is thin: it shines through, and fibres catch light along the outline.
vec3 daylight_on_cloth(vec3 color, vec3 point, vec3 outward, vec3 towards) {
    float facing = dot(outward, lamp);
    vec3 lit_side = facing > 0.0 ? outward : -outward;
    float share = lamp_share(point + lamp_lift * (lit_side + lamp));
    float passed = facing > 0.0 ? facing : -SHINES_THROUGH * facing;
    float fuzz = FUZZ * pow(1.0 - clamp(dot(outward, towards), 0.0, 1.0), FUZZ_POWER);
    vec3 sky = from_sky(outward);
    return to_screen(to_light(color) * (sky + LAMP_LIGHT * passed * share) + fuzz * sky);
}
