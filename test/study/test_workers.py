# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs on the workers of a real Dask cluster of processes."""

import sys

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.workers import Workers
from distributed import LocalCluster
import pytest

SCENE = {'rows': 6, 'cols': 5}


def make(runs, folder, address):
    """Make runs on a cluster."""
    with ResultsFolder(folder) as results:
        return make_runs(runs, results, Workers(scheduler=address), title='test')


def test_a_cluster_makes_the_same_as_this_machine(tmp_path):
    """A study on several machines would differ, or lose what its workers returned."""
    runs = [Run('study_runs:drop', SCENE, {'seconds': seconds}) for seconds in (0.01, 0.02)]
    runs += [Run('study_runs:fail'), Run('study_runs:drop', {'rows': 0}, {'seconds': 0.0})]
    with LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        results = make(runs, tmp_path / 'cluster', cluster.scheduler_address)
    with ResultsFolder(tmp_path / 'here') as folder:
        here = make_runs(runs, folder, Workers(2), title='test')
    assert [result.outcome for result in results] == ['done', 'done', 'failed', 'refused']
    for mine, theirs in zip(here[:2], results):
        assert (mine.arrays['positions'] == theirs.arrays['positions']).all()
        assert mine.values == theirs.values and mine.device == theirs.device


def test_a_worker_with_threads_is_refused(tmp_path):
    """Two runs would use one GL context from two threads, and end in nonsense."""
    with LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False,
            dashboard_address=None) as cluster:
        with pytest.raises(ClothSimError, match='--nthreads 1'):
            make([Run('study_runs:fail')], tmp_path, cluster.scheduler_address)


def test_without_dask_there_is_a_way_out(tmp_path, monkeypatch):
    """A user without Dask would get a traceback."""
    monkeypatch.setitem(sys.modules, 'distributed', None)
    with pytest.raises(ClothSimError, match='pip install distributed'):
        make([Run('study_runs:fail')], tmp_path, 'tcp://127.0.0.1:1')
