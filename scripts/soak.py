# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Use a node for hours as its users do; fail when it dies, or holds ever more. See soak.sh."""

import argparse
import csv
from dataclasses import astuple
from dataclasses import dataclass
from dataclasses import fields
from pathlib import Path
import random
import shutil
import sys
import tempfile
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.model.scene_fields import MODES
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import numpy as np
from processor_time import descriptors
from processor_time import memory
from processor_time import processor_time
from processor_time import threads
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

SCENE = {
    'rows': 32, 'cols': 32, 'dt': 0.005, 'pins': ['top_left', 'top_right'],
    'areal_density': 0.2, 'stiffness.structural': 100.0}
MIB = 2**20
MOST_GROWTH = 2.0   # MiB an hour
WARM_UP = 600.0     # [s], or a sixth of a shorter run
CYCLE = 10.0        # [s]
NAME = '/soak/cloth_sim'


@dataclass
class Sample:
    """What the node holds at the end of a cycle, with no recording under way."""

    seconds: float
    cycles: int
    memory: int
    descriptors: int
    threads: int
    processor: float


class Cloth:
    """Call the node, and listen to what costs Python little to read."""

    def __init__(self, client: GraphClient) -> None:
        """Wait for the node."""
        self.client = client
        self.frames = [
            client.watch(ClothStats, f'{NAME}/stats'),
            client.watch(PointCloud2, f'{NAME}/points')]

    def call(self, kind, service, /, **request):
        """Return the answer of a service; fail when it is a refusal."""
        answer = self.client.call(kind, f'{NAME}/{service}', **request)
        if not answer.success:
            raise RuntimeError(answer.message)
        return answer


def main() -> int:
    """Run the soak and print its outcome."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--hours', type=float, required=True)
    parser.add_argument('--seed', type=int, default=random.SystemRandom().randrange(2**31))
    parser.add_argument('--out', type=Path, help='CSV file for the samples')
    args = parser.parse_args()
    print(f'{args.hours:g} h, --seed {args.seed}', flush=True)
    folder = Path(tempfile.mkdtemp(prefix='cloth_sim_soak_'))
    samples: list[Sample] = []
    with GraphClient() as client, NodeProcess(folder, SCENE, '-r', '__ns:=/soak') as node:
        cloth = Cloth(client)
        begin = time.monotonic()
        drawn = random.Random(args.seed)
        while time.monotonic() - begin < args.hours * 3600.0 and node.running:
            run_cycle(cloth, drawn, len(samples))
            samples.append(Sample(
                time.monotonic() - begin, len(samples) + 1, memory(node.pid),
                descriptors(node.pid), threads(node.pid), processor_time(node.pid)))
            if len(samples) % 30 == 1:
                print(samples[-1], flush=True)
        alive = node.running
        output = node.output
    if args.out:
        with args.out.open('w', newline='') as file:
            writer = csv.writer(file)
            writer.writerow([field.name for field in fields(Sample)])
            writer.writerows(map(astuple, samples))
    shutil.rmtree(folder)
    if not alive:
        print(f'the node has died; it said last:\n{output[-3000:]}')
        return 1
    return judge(samples, args.hours, output)


def run_cycle(cloth: Cloth, drawn: random.Random, number: int) -> None:
    """Record, push, pin, move and switch for some seconds; then stop recording."""
    records = number % 2 == 0
    path = ''
    if records:
        path = cloth.call(StartRecording, 'start_recording').path
    cloth.client.spin_for(0.1 * CYCLE)
    cloth.call(SetMode, 'set_mode', mode=MODES[number % len(MODES)])
    cloth.call(
        ApplyPush, 'apply_push', force=Vector3(z=drawn.uniform(0.1, 0.5)), duration=0.2)
    cloth.client.spin_for(0.3 * CYCLE)
    row, col = drawn.randrange(1, 31), drawn.randrange(1, 31)
    cloth.call(SetPin, 'set_pin', row=row, col=col)
    cloth.call(MovePin, 'move_pin', row=0, col=0, target=Point(
        x=drawn.uniform(-0.1, 0.1), y=0.0, z=1.0), speed=0.5)
    cloth.client.spin_for(0.3 * CYCLE)
    cloth.call(SetPin, 'set_pin', row=row, col=col, release=True)
    cloth.call(SetBool, 'pause', data=True)
    cloth.call(SetBool, 'pause', data=False)
    cloth.client.spin_for(0.3 * CYCLE)
    if records:
        cloth.call(Trigger, 'stop_recording')
        assert BagReader(path).topics, f'{path} cannot be read'
        shutil.rmtree(path)
    if number % 5 == 4:
        cloth.call(Trigger, 'reset')
    for watch in cloth.frames:
        if not watch.messages:
            raise RuntimeError('no frame came within a cycle')
        watch.clear()


def judge(samples: list[Sample], hours: float, output: str) -> int:
    """Print the outcome; return 0 when all is flat."""
    warm_up = min(WARM_UP, hours * 600.0)
    late = [sample for sample in samples if sample.seconds >= warm_up]
    if len(late) < 10:
        print('too short to judge: give more --hours')
        return 1
    times = np.array([sample.seconds for sample in late]) / 3600.0
    held = np.array([sample.memory for sample in late]) / MIB
    growth = np.polyfit(times, held, 1)[0]
    files = {sample.descriptors for sample in late}
    workers = {sample.threads for sample in late}
    faults = output.count('unexpected error')
    print(
        f'{len(samples)} cycles in {samples[-1].seconds / 3600.0:.2f} h: memory {held[0]:.1f} MiB '
        f'after {warm_up / 60.0:.0f} min and {held[-1]:.1f} MiB at the end, {growth:+.2f} MiB an '
        f'hour; descriptors {sorted(files)}, threads {sorted(workers)}, unexpected errors '
        f'{faults}, {samples[-1].processor / samples[-1].seconds:.2f} processors')
    is_flat = growth <= MOST_GROWTH and len(files) == 1 and len(workers) == 1 and not faults
    print('flat' if is_flat else 'NOT flat')
    return 0 if is_flat else 1


if __name__ == '__main__':
    sys.exit(main())
