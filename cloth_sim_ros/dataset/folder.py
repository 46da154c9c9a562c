# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The folder of a data set: its settings, the samples in it, and their annotations."""

from collections.abc import Mapping
import json
import os
from pathlib import Path
from typing import Any

from cloth_sim_ros.dataset.coco import categories
from cloth_sim_ros.dataset.sample import FOLDERS
from cloth_sim_ros.dataset.sample import path_of
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError

_ASKED = 'dataset.json'
ANNOTATIONS = 'annotations.json'
# Largest size of a file of settings or of a sample [bytes]; chosen: 1000 times the largest seen.
_LIMIT = 2**26


class DatasetFolder:
    """
    A data set that is being made, or goes on.

    :param asked: what its samples follow from, and have to agree in
    :raises ClothSimError: when the folder has another data set, or cannot be written
    """

    def __init__(self, path: str, asked: Mapping[str, Any]) -> None:
        """Make the folder, or read its content."""
        self.path = Path(path)
        try:
            self._open(json.loads(json.dumps(asked)))
        except OSError as error:
            raise ClothSimError(
                f'--out {cut(path)} cannot be written ({error.strerror}): give another folder'
            ) from error

    def _open(self, asked: dict[str, Any]) -> None:
        for kind in FOLDERS:
            (self.path / kind).mkdir(parents=True, exist_ok=True)
        file = self.path / _ASKED
        if not file.exists():
            self._write(file, asked)
            return
        there = _parsed(file)
        if there != asked:
            names = sorted(
                name for name in asked
                if not isinstance(there, dict) or there.get(name) != asked[name])
            raise ClothSimError(
                f'{cut(self.path)} has a data set with other values of {", ".join(names)}: give '
                'the same, or another --out')

    def missing(self, count: int) -> list[int]:
        """Return which of the first ``count`` samples are not there."""
        return [
            number for number in range(count)
            if not path_of(self.path, 'samples', number).exists()]

    def annotate(self, count: int) -> int:
        """Write the annotations of the first ``count`` samples; return how many there are."""
        images: list[dict[str, Any]] = []
        entries: list[dict[str, Any]] = []
        names: list[str] = []
        for number in range(count):
            file = path_of(self.path, 'samples', number)
            if not file.exists():
                continue
            sample = _parsed(file)
            try:
                names = sample['label_names']
                images.append({
                    'id': number, 'file_name': f'images/{number:06d}.png',
                    'width': sample['width'], 'height': sample['height']})
                for entry in sample['annotations']:
                    entries.append({'id': len(entries) + 1, 'image_id': number, **entry})
            except (TypeError, KeyError) as error:
                raise ClothSimError(
                    f'{cut(file)} is not as it was written: remove it, and give the same command '
                    'again, which makes that sample anew') from error
        self._write(self.path / ANNOTATIONS, {
            'images': images, 'annotations': entries, 'categories': categories(names)})
        return len(images)

    def _write(self, file: Path, content: Mapping[str, Any]) -> None:
        passing = file.with_suffix('.part')
        passing.write_text(json.dumps(content), encoding='utf-8')
        os.replace(passing, file)


def _parsed(file: Path) -> Any:
    """Return what a JSON file holds; None if it is none."""
    try:
        return json.loads(read_regular(file, _LIMIT))
    except (ValueError, RecursionError):
        return None
