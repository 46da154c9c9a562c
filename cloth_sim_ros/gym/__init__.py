# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Cloth as an environment of gymnasium, which has to be installed: `pip install gymnasium`.

Importing this registers ``cloth_sim_ros/CarryCloth-v0`` for `gymnasium.make`.
"""

try:
    from cloth_sim_ros.gym.carry_cloth import CarryCloth
    import gymnasium
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        f'cloth_sim_ros.gym cannot be used without {error.name}: install it with `pip install '
        'gymnasium`', name=error.name) from error

__all__ = ('CarryCloth',)

if 'cloth_sim_ros/CarryCloth-v0' not in gymnasium.registry:
    gymnasium.register(
        'cloth_sim_ros/CarryCloth-v0', 'cloth_sim_ros.gym.carry_cloth:CarryCloth',
        max_episode_steps=200)
