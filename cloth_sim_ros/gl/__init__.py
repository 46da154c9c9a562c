# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compute shaders without a window: context, program, buffers. No cloth here."""

import os

# PyOpenGL picks its platform when it is first imported. No other has contexts without a window.
os.environ['PYOPENGL_PLATFORM'] = 'egl'
# Warnings of Mesa while it looks for a device are not shown: DeviceError reports a failure.
os.environ.setdefault('EGL_LOG_LEVEL', 'fatal')
