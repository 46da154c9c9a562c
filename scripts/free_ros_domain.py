#!/usr/bin/env python3
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


"""Print a ROS_DOMAIN_ID that nobody on this machine uses."""

from pathlib import Path
import random
import sys

# The domains above the ports that Linux gives to clients; people take the low ones.
DOMAINS = range(215, 233)
# A participant of domain d listens on UDP ports from 7400 + 250 d on.
FIRST_PORT = 7400
PORTS = 250


def domains_in_use(sockets: str) -> set[int]:
    """Return the domains whose ports are taken in ``sockets``, the text of /proc/net/udp."""
    return {
        (int(line.split()[1].rpartition(':')[2], 16) - FIRST_PORT) // PORTS
        for line in sockets.splitlines()[1:]}


def main() -> int:
    """Print one at random, so that two who ask at once hardly get the same."""
    used = domains_in_use(Path('/proc/net/udp').read_text(encoding='ascii'))
    free = [domain for domain in DOMAINS if domain not in used]
    if not free:
        print(f'all ROS domains from {DOMAINS[0]} to {DOMAINS[-1]} are in use: '
              'end one of their nodes', file=sys.stderr)
        return 1
    print(random.choice(free))
    return 0


if __name__ == '__main__':
    sys.exit(main())
