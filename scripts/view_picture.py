# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Make the picture of the live view in docs/how_to/view.md, with a headless Chromium.

    python scripts/view_picture.py --out docs/figures/view.png

Needs what scripts/setup.sh --long installs.
"""

from argparse import ArgumentParser
from argparse import RawDescriptionHelpFormatter
import io
from pathlib import Path
import sys
import tempfile

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'test' / 'support'))

from browser import Browser  # noqa: E402
from cloth_sim_ros.sim.model.given_values import load_parameters  # noqa: E402
from cloth_sim_ros.sim.scene import Scene  # noqa: E402
from cloth_sim_ros.view.scene_source import SceneSource  # noqa: E402
from PIL import Image  # noqa: E402
from served_view import served  # noqa: E402

_WINDOW = (960, 640)
# Without the note of the browser that it has no GPU.
_SHOWN = (330, 0, 960, 560)
_STEPS = 90


def main() -> None:
    """Write the picture."""
    parser = ArgumentParser(description=__doc__, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument('--out', required=True, metavar='FILE.png')
    path = parser.parse_args().out
    scene = Scene(load_parameters(ROOT / 'config' / 'towel.yaml'))
    source = SceneSource(scene, 'towel', frame_seconds=0.02, is_paused=True)
    source.step(_STEPS)
    with served(source) as address, tempfile.TemporaryDirectory(
            ignore_cleanup_errors=True) as folder:
        with Browser(Path(folder), address, _WINDOW) as browser:
            browser.wait_for('towel, paused')
            # The panel opens in several images.
            picture, before = browser.picture(), b''
            while picture != before:
                picture, before = browser.picture(), picture
            Image.open(io.BytesIO(picture)).crop(_SHOWN).save(path)


if __name__ == '__main__':
    main()
