# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Compute shaders without a window: context, program, buffers. Knows nothing of cloth."""

import os

# PyOpenGL picks its platform when it is first imported. No other has contexts without a window.
os.environ['PYOPENGL_PLATFORM'] = 'egl'
# What Mesa warns of on the way to a device is no news: the refusal tells it, or there is a device.
os.environ.setdefault('EGL_LOG_LEVEL', 'fatal')
