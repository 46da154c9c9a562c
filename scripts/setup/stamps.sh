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

# What was done from which input, so that a second run does only what has changed.

# Digest of the given files and folders, names and contents, and of the text on standard input.
digest() {
  {
    cat
    find "$@" -type f -not -path '*/__pycache__/*' -print0 | LC_ALL=C sort -z |
      xargs -0 sha256sum
  } | sha256sum | cut -d ' ' -f 1
}

is_current() {
  [ "$(cat "$stamps/$1" 2> /dev/null)" = "$2" ]
}

# Written last, in one go: a step that was interrupted has no stamp and is done again.
set_stamp() {
  printf '%s\n' "$2" > "$stamps/$1.new"
  mv "$stamps/$1.new" "$stamps/$1"
}

clear_stamp() {
  rm -f "$stamps/$1"
}
