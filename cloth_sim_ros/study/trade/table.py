# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
