# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compute shaders without a window: context, program, buffers. Knows nothing of cloth."""

import os

# PyOpenGL picks its platform when it is first imported. No other has contexts without a window.
os.environ['PYOPENGL_PLATFORM'] = 'egl'
# What Mesa warns of on the way to a device is no news: the refusal tells it, or there is a device.
os.environ.setdefault('EGL_LOG_LEVEL', 'fatal')
