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

# Say what is being done, and show that a long step is alive.

say() {
  printf '%s\n' "$*"
}

stop() {
  printf 'setup: %s\n' "$*" >&2
  exit 1
}

# The last line a command wrote, short, without the addresses it may name.
latest_line() {
  tr '\r' '\n' < "$1" | grep -v '^ *$' | tail -n 1 |
    sed -E 's#[a-z]+://[^ ]*/##g' | cut -c 1-80
}

report_while_running() {
  local text=$1 log=$2 started=$SECONDS seconds
  while sleep 5 && kill -0 $$ 2> /dev/null; do
    seconds=$((SECONDS - started))
    printf '  %s: %d s: %s\n' "$text" "$seconds" "$(latest_line "$log")"
  done
}

# long_step TEXT COMMAND...: run the command in the foreground, so that Ctrl-C reaches it.
long_step() {
  local text=$1 log status=0 reporter started=$SECONDS
  shift
  log=$(mktemp "${TMPDIR:-/tmp}/cloth_sim_setup.XXXXXX")
  say "$text ..."
  report_while_running "$text" "$log" 9<&- &
  reporter=$!
  "$@" > "$log" 2>&1 < /dev/null || status=$?
  kill "$reporter" 2> /dev/null || true
  wait "$reporter" 2> /dev/null || true
  if [ "$status" -ne 0 ]; then
    tail -n 30 "$log" >&2
    stop "$text failed after $((SECONDS - started)) s; all of its output is in $log"
  fi
  rm -f "$log"
  say "$text: done in $((SECONDS - started)) s."
}
