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

"""The table of a study of the trade, as CSV and as lines of JSON."""

from collections.abc import Sequence
import csv
import json
from pathlib import Path

from cloth_sim_ros.study.trade.row import Row


def write_table(folder: Path, rows: Sequence[Row]) -> None:
    """Write table.csv and table.jsonl into ``folder``, a line for each row."""
    lines = [row.as_dict() for row in rows]
    with open(folder / 'table.csv', 'w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, lines[0])
        writer.writeheader()
        writer.writerows(lines)
    text = ''.join(f'{json.dumps(line)}\n' for line in lines)
    (folder / 'table.jsonl').write_text(text, encoding='utf-8')
