# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0
# How far a long step is, in a few words, from what its command has printed so far.

# Print how many requirements of a lock file are for this Python, by the Python of the venv.
requirements_here() {
  "$venv/bin/python" - "$1" << 'PYTHON'
import sys
from pip._vendor.packaging.requirements import Requirement
lines = [line.rstrip(' \\\n') for line in open(sys.argv[1]) if line[0] not in '# \n']
print(sum(r.marker is None or r.marker.evaluate() for r in map(Requirement, lines)))
PYTHON
}

# pip writes INSTALLER last, when a package is complete.
installed_packages() {
  compgen -G "$venv/lib/python3.*/site-packages/*.dist-info/INSTALLER" | wc -l
}

# pip finds and downloads one package after the other, and then installs all without a word.
pip_words() {
  local found new
  # What was said before the last run of pip had its success does not count.
  read -r found new < <(awk '
    /^Successfully installed / { split("", names); found = new = 0 }
    /^(Collecting|Requirement already satisfied:) / {
      name = $0; sub(/^(Collecting|Requirement already satisfied:) /, "", name)
      sub(/[^A-Za-z0-9._-].*/, "", name); found += !names[name]++ }
    /^Installing collected packages: / { new = gsub(/,/, "") + 1 }
    END { print found + 0, new + 0 }' "$1")
  if [ "$new" -gt 0 ]; then
    found=$(($(installed_packages) - packages_before))
    printf '%d of %d packages installed' "$((found < 0 ? 0 : found > new ? new : found))" "$new"
  else
    printf '%d of %d packages found' \
      "$((found > packages_total ? packages_total : found))" "$packages_total"
  fi
}

apt_words() {
  local total
  total=$(sed -nE 's/.* ([0-9]+) newly installed.*/\1/p' "$1" | tail -n 1)
  [ -z "$total" ] ||
    printf '%d of %d packages installed' "$(grep -c '^Setting up ' "$1")" "$total"
}

# Print the share that is built, on average over the logs.
cmake_words() {
  awk '
    match($0, /^\[ *[0-9]+%\]/) { share[FILENAME] = substr($0, 2, RLENGTH - 3) }
    END { for (name in share) { sum += share[name]; begun = 1 }
      if (begun) printf "%d %% built", sum / (ARGC - 1) }' "$@"
}
