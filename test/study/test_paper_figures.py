# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The runs of Fig. 10 and 11 of the paper."""

from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.paper_figures import FIGURES
from cloth_sim_ros.study.paper_figures import paper_scene_file
from pushed_scenes import paper_scene
import pytest

RUNS = [(figure, run) for figure, made in FIGURES.items() for run in made.runs]


def scene_of(changes):
    """Return the scene of the file with ``changes``."""
    of_the_node = {field.name for field in NODE_FIELDS}
    values = {**load_parameters(paper_scene_file()), **changes}
    return Scene({name: value for name, value in values.items() if name not in of_the_node})


def test_the_scene_is_the_one_the_limits_were_measured_in():
    """The pictures would show another cloth than the tables of docs/explanation/adaptive.md."""
    ours = scene_of({'mode': 'adaptive', 'dt': 0.01, 'start.z': 1.0}).values
    theirs = Scene(paper_scene(5.0, 0.01)).values
    assert ours.pop('pushes.force') == pytest.approx(theirs.pop('pushes.force'))
    assert ours == theirs


@pytest.mark.parametrize(('figure', 'run'), RUNS, ids=[f'{f}-{run.name}' for f, run in RUNS])
def test_only_the_papers_ways_pass_the_stability_limit(figure, run):
    """A run of the project's own would be excused from its check, or be refused."""
    scene = scene_of(run.changes)
    passes = not scene['auto_substeps'] and scene['mode'] != 'constraint' and (
        scene['dt'] > stability_limit(scene))
    assert run.check_stability or 'paper' in run.label
    assert not (passes and run.check_stability)


def test_the_figures_have_the_papers_steps():
    """The rows would not be those of the paper's text."""
    dts = {name: {scene_of(run.changes)['dt'] for run in made.runs}
           for name, made in FIGURES.items()}
    assert dts == {'fig10': {0.005}, 'fig11': {0.01, 0.02}}


@pytest.mark.parametrize('figure', FIGURES)
def test_no_recording_overwrites_another(figure):
    """The second of two runs with one name would be refused."""
    names = [run.name for run in FIGURES[figure].runs]
    assert len(set(names)) == len(names)
