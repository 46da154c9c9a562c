# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Daylight on cloth and bodies: how strong each part of it is."""

# Light of a surface of white that faces the sun, and what comes from above and from below [1].
LIGHT_DEFINES = {
    'LAMP_LIGHT': 0.74, 'SKY_LIGHT': 0.40, 'FLOOR_LIGHT': 0.18,
    'SHINES_THROUGH': 0.22, 'FUZZ': 0.12, 'FUZZ_POWER': 3.0}
# Taps of a shadow [1]: half as many as a still picture has, and none within the disc where all or
# none of the rim is lit. A picture of 640 x 480 takes half the time.
DAYLIGHT_DEFINES = {**LIGHT_DEFINES, 'LAMP_TAPS': 12, 'LAMP_RIM_TAPS': 4}
# Sides of the picture that the sun has of the scene, for shadows [pixel]: the first whose pixels
# are small enough.
DEPTH_SIDES = (256, 512, 1024)
# Largest pixel of that picture over the radius of the soft edge of a shadow [1].
DEPTH_PIXEL = 0.25
# Texture units of that picture, render/lamp.glsl.
DEPTH_UNIT, NEAREST_DEPTH_UNIT = 2, 4
