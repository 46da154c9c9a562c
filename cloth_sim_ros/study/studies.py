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
