# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The studies that `cloth_sim study` knows.

A study is a module of this package with `add_arguments(parser)` and `main(args) -> int`, the exit
code; its docstring is its help text. Where it has `TAKES_SCENE = True`, the verb adds SCENE.yaml
and --set, and `args.scene` is the Scene when main is called.
"""

STUDIES = {
    'tradeoff': 'accuracy-cost trade-off of modes and settings for a scene',
    'presets': 'values of the parameter preset, derived from a tradeoff study',
    'stability': 'measured and predicted stability limits of each mode',
    'extremes': 'robustness against extreme scenes in every mode',
    'answers': 'service response times of a node, also while a mode is compiled',
    'cost': 'cost of each feature of a scene, and the error without it',
}
