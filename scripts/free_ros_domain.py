#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


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
