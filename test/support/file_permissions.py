# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A process that file permissions hold for, whoever runs the tests."""

# Root passes over permissions by two capabilities: the process gives them up. As any other user
# it has none to give up.
WITHOUT_OVERRIDE = """
import ctypes
libc = ctypes.CDLL(None, use_errno=True)
head = (ctypes.c_uint32 * 2)(0x20080522, 0)
sets = (ctypes.c_uint32 * 6)()
assert libc.capget(head, sets) == 0
for place in range(3):
    sets[place] &= ~0b110  # CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH
assert libc.capset(head, sets) == 0
"""
