#!/usr/bin/env bash
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

# Set up and run the tests; arguments go to pytest.
#
#   scripts/test.sh                  the ordinary tests, on all processors (at most 4)
#   scripts/test.sh --long           the long ones as well
#   scripts/test.sh test/sim -k pin  some of them

set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in
  *' --long '*) scripts/setup.sh --long ;;
  *) scripts/setup.sh --tests ;;
esac
. scripts/env.sh
# Files stay together: their tests share nodes and simulations.
[ $# -gt 0 ] || set -- --numprocesses=auto --maxprocesses=4 --dist=loadfile
exec python -m pytest "$@"
