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


# Show what cloth_sim_ros does: set up, start the node, push its cloth through its services, record
# it, and draw what was recorded. Takes under a minute once everything is set up.
#
#   scripts/demo.sh             records into bags/
#   scripts/demo.sh DIRECTORY   records into DIRECTORY

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
node=''
scratch=''

fail() {
  echo "demo.sh: $1" >&2
  exit 1
}

tell() {
  printf '\n%s\n' "$1"
}

# End the node the way Ctrl-C does, and wait until it has ended.
stop_node() {
  local signal
  for signal in INT TERM KILL; do
    kill "-$signal" "$node" 2> /dev/null || break
    for _ in {1..100}; do
      kill -0 "$node" 2> /dev/null || break 2
      sleep 0.1
    done
  done
  wait "$node"
}

clean_up() {
  local status=$?
  trap - EXIT INT TERM HUP
  if [ -n "$node" ]; then
    stop_node || true
    echo 'demo.sh: stopped early; the node has ended, and its recording is closed.' >&2
    tail -n 5 "$scratch/node.log" >&2
  fi
  [ -z "$scratch" ] || rm -rf "$scratch"
  exit "$status"
}

start_node() {
  cloth_sim_node --ros-args --params-file "$root/config/drape.yaml" \
    -p start_paused:=true -p "recording.directory:=$bags" > "$scratch/node.log" 2>&1 &
  node=$!
  for _ in {1..20}; do
    kill -0 "$node" 2> /dev/null || {
      node=''
      cat "$scratch/node.log" >&2
      fail 'the node did not start, for the reason above'
    }
    if cloth_sim status --json --timeout 2 > "$scratch/status.json" 2> /dev/null; then
      return
    fi
  done
  fail 'the node does not answer'
}

# What the node said of itself when it had started: field STATE.FIELD.
status() {
  python -c 'import functools, json, sys
value = functools.reduce(dict.get, sys.argv[2].split("."), json.load(open(sys.argv[1])))
print(*value if isinstance(value, list) else [value])' "$scratch/status.json" "$1"
}

switch_modes() {
  local mode
  for mode in constraint adaptive mass_spring; do
    cloth_sim mode "$mode"
  done
}

trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

[ $# -le 1 ] || fail "unknown arguments: $*: give a directory for the recording, or nothing"
bags=$(realpath -m "${1:-$root/bags}")

"$root/scripts/setup.sh"
# shellcheck source=scripts/env.sh
. "$root/scripts/env.sh"
scratch=$(mktemp -d)
# A ROS graph of its own, on this machine only.
ROS_DOMAIN_ID=$(python "$root/scripts/free_ros_domain.py")
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
ROS_LOG_DIR=$scratch
export ROS_DOMAIN_ID ROS_AUTOMATIC_DISCOVERY_RANGE ROS_LOG_DIR

tell 'Starting cloth_sim_node with config/drape.yaml, paused.'
start_node
echo "device: $(status state.device)"
echo "To watch: ROS_DOMAIN_ID=$ROS_DOMAIN_ID rviz2 -d $root/config/cloth_sim.rviz"

tell 'Recording, and letting the cloth fall.'
recording=$(cloth_sim record start)
cloth_sim resume
sleep 1

tell 'Pushing the whole cloth, then its upper edge.'
cloth_sim push --force 0 1 1.5 --duration 0.3
cloth_sim push --force 0 -0.8 0 --center 0 0.5 0.9 --radius 0.3 --duration 0.2

tell 'Switching modes; what this version does not have, it says.'
switch_modes

tell 'Pausing, making 100 steps by hand, and going on.'
cloth_sim pause
cloth_sim step 100
cloth_sim resume

tell 'Letting the cloth go at its top right corner.'
cloth_sim pin --near 0.5 0.5 1.0 --release
sleep 1

tell 'Closing the recording, and stopping the node with SIGINT.'
cloth_sim record stop
stopping=$node
stop_node || fail "the node ended with exit code $?"
node=''
echo "node $stopping has ended"

tell 'What was recorded:'
cloth_sim info "$recording"
picture=$recording.png
cloth_sim render "$recording" --out "$picture" > /dev/null
tell "recording  $recording
picture    $picture"
