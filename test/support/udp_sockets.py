# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The UDP sockets of a process, which tell who can reach it."""

from pathlib import Path
import socket


def udp_sockets(pid: int) -> list[tuple[str, int]]:
    """Return address and port of each IPv4 socket that a process has bound."""
    own = set()
    for link in Path(f'/proc/{pid}/fd').iterdir():
        try:
            own.add(str(link.readlink()))
        except OSError:
            continue  # it was closed meanwhile
    found = []
    for line in Path(f'/proc/{pid}/net/udp').read_text(encoding='ascii').splitlines()[1:]:
        _, local, *_, inode = line.split()[:10]
        if f'socket:[{inode}]' in own:
            host, port = local.split(':')
            found.append((socket.inet_ntoa(bytes.fromhex(host)[::-1]), int(port, 16)))
    return found
