#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

# Show what cloth_sim_ros does: set up, start the node, push its cloth through its services, record
# it, and draw what was recorded. Takes under a minute once everything is set up. What is done to the
# cloth is done at simulated times: the same on every machine, however slow.
#
#   scripts/demo.sh             records into bags/
#   scripts/demo.sh DIRECTORY   records into DIRECTORY

set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
node=''
scratch=''
recording=''
# Wall seconds to wait for an answer, on a machine that has much else to do.
patience=300

fail() {
  echo "demo.sh: $1" >&2
  exit 1
}

tell() {
  printf '\n%s\n' "$1"
}

# end PROCESS SIGNAL...: send one signal after the other until it has ended.
end() {
  local process=$1 signal
  for signal in "${@:2}"; do
    kill "-$signal" "$process" 2> /dev/null || break
    for _ in {1..300}; do
      kill -0 "$process" 2> /dev/null || break 2
      sleep 0.1
    done
  done
  wait "$process"
}

clean_up() {
  local status=$?
  trap - EXIT INT TERM HUP
  # By the list of jobs: a signal may come between the start of a process and the next command.
  local process
  for process in $(jobs -p); do
    [ "$process" = "$node" ] || end "$process" TERM KILL || true
  done
  if [ -n "$node" ]; then
    # The way Ctrl-C does it, which closes the recording.
    end "$node" INT TERM KILL || true
    echo 'demo.sh: stopped early; the node has ended, and its recording is closed. It said last:' >&2
    tail -n 5 "$scratch/node.log" >&2
  fi
  if [ "$status" -ne 0 ] && [ -n "$recording" ]; then
    echo "demo.sh: what was recorded until then: $recording" >&2
  fi
  [ -z "$scratch" ] || rm -rf "$scratch"
  exit "$status"
}

# In the background, so that a signal ends it as well; with the terminal, where there is one.
set_up() {
  "$root/scripts/setup.sh" <&0 &
  wait $! || exit 1
}

# Ask the node, and wait patiently; in the background, so that a signal is not kept waiting.
ask() {
  cloth_sim "$@" --timeout "$patience" &
  wait $!
}

start_node() {
  local begin=$SECONDS
  cloth_sim_node --ros-args --params-file "$root/config/drape.yaml" \
    -p start_paused:=true -p "recording.directory:=$bags" > "$scratch/node.log" 2>&1 &
  node=$!
  until cloth_sim status --json --timeout 2 > "$scratch/status.json" 2> /dev/null; do
    kill -0 "$node" 2> /dev/null || {
      node=''
      cat "$scratch/node.log" >&2
      fail 'the node did not start, for the reason above'
    }
    [ $((SECONDS - begin)) -lt "$patience" ] || fail "the node does not answer within $patience s"
  done
}

# What the node said of itself when it had started: field STATE.FIELD.
status() {
  python -c 'import functools, json, sys
value = functools.reduce(dict.get, sys.argv[2].split("."), json.load(open(sys.argv[1])))
print(*value if isinstance(value, list) else [value])' "$scratch/status.json" "$1"
}

# Make steps of 5 ms, and show and record the cloth every 20 ms.
simulate() {
  ask step "$1" --every 4
}

switch_modes() {
  local mode
  for mode in constraint adaptive mass_spring; do
    ask mode "$mode"
    simulate 20
  done
}

trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
trap 'exit 129' HUP

[ $# -le 1 ] || fail "unknown arguments: $*: give a directory for the recording, or nothing"
bags=$(realpath -m "${1:-$root/bags}")

set_up
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

tell 'Recording, and letting the cloth fall for one second of simulated time.'
ask record start > "$scratch/recording"
recording=$(cat "$scratch/recording")
simulate 200

tell 'Pushing the whole cloth, then its upper edge.'
ask push --force 0 1 1.5 --duration 0.3
simulate 80
ask push --force 0 -0.8 0 --center 0 0.5 0.9 --radius 0.3 --duration 0.2
simulate 60

tell 'Switching modes, with 0.1 s in each.'
switch_modes

tell 'Letting time run by itself, for half a second or more, and pausing.'
ask resume
ask status --until 2.5 > /dev/null
ask pause

tell 'Letting the cloth go at its top right corner.'
ask pin --near 0.5 0.5 1.0 --release
simulate 140

tell 'Closing the recording, and stopping the node with SIGINT.'
ask record stop
end "$node" INT TERM KILL || {
  code=$?
  node=''
  fail "the node ended with exit code $code"
}
echo "node $node has ended"
node=''

tell 'What was recorded:'
cloth_sim info "$recording"
picture=$recording.png
cloth_sim render "$recording" --out "$picture" > /dev/null
tell "recording  $recording
picture    $picture"
