# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Plots of a run: which there are, their units, and what was done to the cloth."""

from cloth_sim_ros.analysis.plots import run_plots
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.model.push import Push
from made_snapshot import make_snapshot
from matplotlib.backends.backend_agg import FigureCanvasAgg
import numpy as np
import pytest
from rclpy.serialization import serialize_message

PUSH = Push.checked(force=(0.0, 0.0, 2.0), start=0.2, duration=0.3)


@pytest.fixture(scope='module')
def run(tmp_path_factory):
    """Return a run with a push, a switch to mode constraint, constraints and a gap."""
    recorder = Recorder(tmp_path_factory.mktemp('plots'), 'run')

    def write(key, message, time):
        recorder.write(key, serialize_message(message), time)

    write(*input_message(SetMode('adaptive'), 0.0, 'world'), 0.0)
    for number in (*range(60), *range(70, 100)):
        time = number / 50
        in_constraint = number > 50
        snapshot = make_snapshot(
            4, 4, time=time, kinetic_energy=1.0 + time, active_constraints=number % 7,
            listed_substeps=0 if in_constraint else 3, strain_bound=0.0 if in_constraint else 0.1,
            solver_iterations=9 if in_constraint else 0,
            solver_residual=10.0**-(3 + number % 3) if in_constraint else 0.0)
        recorder.write('points', PointsMessage(4, 4, 'world').serialise(snapshot), time)
        write('stats', stats_message(
            snapshot, 'world', step_wall_time=2e-3, real_time_factor=2.5), time)
        if number == 10:
            write(*input_message(PushNodes(PUSH), time, 'world'), time)
        if number == 50:
            change = SetMode('constraint', 'adaptive')
            write(*input_message(change, time, 'world'), time)
    recorder.close()
    return Run(Recording(recorder.path))


@pytest.fixture(scope='module')
def figures(run):
    """Return the drawn figures of the run by name."""
    made = dict(run_plots(run))
    for figure in made.values():
        FigureCanvasAgg(figure).draw()
    return made


def test_there_is_a_plot_of_each_part(figures):
    """A part of the run would not be shown."""
    assert set(figures) == {
        'energies', 'strain', 'constraints', 'limits', 'solver', 'pace', 'strain_histogram'}


def test_axes_tell_what_they_show_and_in_which_unit(figures):
    """A reader would have to guess."""
    labels = {
        axes.get_ylabel() for figure in figures.values() for axes in figure.axes}
    assert labels == {
        'energy [J]', 'strain [%]', 'active constraints', 'switches in the last step',
        'substeps of the last step', 'edges listed in a substep', 'rounds of a substep',
        'largest strain / limit', 'iterations, most of a solve', 'relative residual, worst solve',
        'wall time of a step [ms]', 'real-time factor', 'fraction of the nodes in each of 50 bins'}
    assert {figure.axes[-1].get_xlabel() for figure in figures.values()} == {
        'simulated time [s]', 'strain, largest of the springs at a node [%]'}
    assert figures['solver'].axes[1].get_yscale() == 'log'


def test_lines_are_the_figures_of_the_run(run, figures):
    """A line would be of another quantity, or in another unit."""
    for name, place, column, scale in (
            ('energies', 0, 'kinetic_energy', 1.0), ('strain', 0, 'max_strain', 100.0),
            ('limits', 1, 'listed_substeps', 1.0), ('pace', 0, 'step_wall_time', 1e3)):
        line = figures[name].axes[0].lines[place]
        drawn = line.get_ydata()
        np.testing.assert_allclose(drawn[~np.isnan(drawn)], scale * run.columns[column])


def test_nothing_is_drawn_across_a_gap(figures):
    """Frames that are missing would seem to have been there."""
    times = figures['energies'].axes[0].lines[0].get_xdata()
    assert np.flatnonzero(np.isnan(times)).tolist() == [60]
    assert times[59] == pytest.approx(1.18) and times[61] == pytest.approx(1.4)


def test_pushes_and_switches_are_marked(figures):
    """What the cloth answers to would not be seen."""
    for name, figure in figures.items():
        if name == 'strain_histogram':
            continue
        for axes in figure.axes:
            span, = axes.patches
            begin, end = span.get_x(), span.get_x() + span.get_width()
            assert (begin, end) == pytest.approx((0.2, 0.5)), name
            assert [line.get_xdata()[0] for line in axes.lines
                    if line.get_label() == 'mode switch'] == [1.0]
        assert [text.get_text() for text in figure.axes[0].texts] == ['constraint']


def test_nothing_overlaps(figures):
    """Words would be drawn over the lines, over each other, or beyond the edge."""
    for name, figure in figures.items():
        renderer = FigureCanvasAgg(figure).get_renderer()
        places = [axes.get_window_extent(renderer) for axes in figure.axes]
        words = [figure._suptitle.get_window_extent(renderer)]
        for axes in figure.axes:
            words += [text.get_window_extent(renderer) for text in axes.texts]
            words += [axes.yaxis.label.get_window_extent(renderer)]
            if axes.get_legend():
                words.append(axes.get_legend().get_window_extent(renderer))
        for number, word in enumerate(words):
            others = places + words[:number]
            assert not any(word.overlaps(other) for other in others), name
            assert word.x0 >= 0 and word.x1 <= figure.bbox.width, name


def test_parts_that_a_run_has_not_are_left_out(known):
    """A plot of zeros would show a solver that the run did not use."""
    assert {name for name, _ in run_plots(Run(Recording(known.folder)))} == {
        'energies', 'strain', 'pace', 'strain_histogram'}


@pytest.mark.filterwarnings('error')
def test_a_stepped_run_has_no_empty_panel(tmp_path):
    """A pause would be drawn as a panel without a line, with a warning on the terminal."""
    recorder = Recorder(tmp_path, 'stepped')
    for time in (0.0, 0.02, 0.04):
        snapshot = make_snapshot(4, 4, time=time)
        recorder.write('points', PointsMessage(4, 4, 'world').serialise(snapshot), time)
        recorder.write('stats', serialize_message(stats_message(
            snapshot, 'world', step_wall_time=2e-3, real_time_factor=0.0)), time)
    recorder.close()
    pace = dict(run_plots(Run(Recording(recorder.path))))['pace']
    assert [axes.get_ylabel() for axes in pace.axes] == ['wall time of a step [ms]']
