# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Cloth as an environment of gymnasium, which has to be installed: `pip install gymnasium`.

Importing this registers ``cloth_sim_ros/CarryCloth-v0`` for `gymnasium.make`, and for
`gymnasium.make_vec`, whose cloths step together.
"""

try:
    from cloth_sim_ros.gym.carry_cloth import CarryCloth
    from cloth_sim_ros.gym.carry_task import CarryTask
    from cloth_sim_ros.gym.many_cloths import CarryCloths
    from cloth_sim_ros.gym.many_cloths import make_vec
    from cloth_sim_ros.gym.many_cloths import MAX_STEPS
    import gymnasium
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        f'cloth_sim_ros.gym cannot be used without {error.name}: install it with `pip install '
        'gymnasium`', name=error.name) from error

__all__ = ('CarryCloth', 'CarryCloths', 'CarryTask', 'make_vec')

if 'cloth_sim_ros/CarryCloth-v0' not in gymnasium.registry:
    gymnasium.register(
        'cloth_sim_ros/CarryCloth-v0', 'cloth_sim_ros.gym.carry_cloth:CarryCloth',
        max_episode_steps=MAX_STEPS,
        vector_entry_point='cloth_sim_ros.gym.many_cloths:made_by_name')
