#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Set up and run the tests; arguments go to pytest.
#
#   scripts/test.sh                  the ordinary tests, in two processes more than processors
#   scripts/test.sh --long           the long ones as well
#   scripts/test.sh test/sim -k pin  some of them

set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in
  *' --long '*) scripts/setup.sh --long ;;
  *) scripts/setup.sh --tests ;;
esac
. scripts/env.sh
# Else each of the many processes that tests start would compile the package anew.
unset PYTHONDONTWRITEBYTECODE
# Files stay together: their tests share nodes and simulations. Some wait for a node, and leave their
# processor to another process. Their order is that of test/conftest.py.
processors=$(nproc)
[ $# -gt 0 ] || set -- --numprocesses=$((processors < 4 ? processors + 2 : 6)) --dist=loadfile \
  --no-loadscope-reorder
exec python -m pytest "$@"
