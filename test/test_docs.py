# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pages of docs become a web site without a warning."""

from pathlib import Path
import re
import shutil
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[1]


def build(folder: Path) -> subprocess.CompletedProcess:
    """Build the pages of a copy of mkdocs.yml and docs; a warning is an error there."""
    return subprocess.run(
        [sys.executable, '-m', 'mkdocs', 'build', '--site-dir', folder / 'site'],
        cwd=folder, capture_output=True, text=True)


@pytest.fixture
def copied(tmp_path) -> Path:
    """Return a folder with copies of mkdocs.yml and docs."""
    shutil.copy(ROOT / 'mkdocs.yml', tmp_path)
    shutil.copytree(ROOT / 'docs', tmp_path / 'docs')
    return tmp_path


def test_every_page_is_built(copied):
    """The site would lack a page, show code as text, or have a link that leads nowhere."""
    done = build(copied)
    assert done.returncode == 0, done.stderr
    for page in (copied / 'docs').rglob('*.md'):
        name = page.relative_to(copied / 'docs').with_suffix('')
        place = name.parent if name.name == 'index' else name
        html = (copied / 'site' / place / 'index.html').read_text(encoding='utf-8')
        # A fence that Markdown did not take for one, as in a list.
        assert not re.search('```|<p><code>(?:text|python|yaml|glsl)\n', html), page


@pytest.mark.parametrize('mistake', [
    '[a page](no_page.md)',
    '[a heading](index.md#no-heading)',
    '![a picture](figures/no_picture.png)'])
def test_what_leads_nowhere_is_an_error(copied, mistake):
    """A broken link or a missing picture would go unnoticed."""
    with open(copied / 'docs' / 'index.md', 'a', encoding='utf-8') as page:
        page.write(f'\n{mistake}\n')
    done = build(copied)
    assert done.returncode != 0
    assert 'index.md' in done.stderr


def test_a_page_without_a_place_is_an_error(copied):
    """A page would be in no menu."""
    (copied / 'docs' / 'lost.md').write_text('# Lost\n', encoding='utf-8')
    assert build(copied).returncode != 0


def test_the_index_links_every_page():
    """A page would be in the menu of the site alone, which nobody sees in the repository."""
    docs = ROOT / 'docs'
    index = (docs / 'index.md').read_text(encoding='utf-8')
    assert [str(page) for page in sorted(docs.rglob('*.md'))
            if page.name != 'index.md' and f'({page.relative_to(docs)})' not in index] == []
