# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A scene without a feature is the same scene otherwise, and compiles nothing of it."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.cost import passes_report
from cloth_sim_ros.study.feature_costs import has_feature
from cloth_sim_ros.study.feature_costs import modelled
from cloth_sim_ros.study.feature_costs import pass_list
from cloth_sim_ros.study.feature_costs import pass_table
from cloth_sim_ros.study.feature_costs import SCENE_FEATURES
from cloth_sim_ros.study.feature_costs import without
import pytest
from springs import SPRINGS

FULL = {
    **SPRINGS, 'rows': 6, 'cols': 6, 'dt': 0.002, 'mode': 'adaptive', 'start.jitter': 0.01,
    'air.density': 1.225, 'air.wind': [1.0, 0.0, 0.0], 'bending.rigidity': 1e-4,
    'pushes.start': [0.0], 'pushes.duration': [0.01], 'pushes.force': [0.0, 0.0, 1.0],
    'pushes.center': [0.0, 0.0, 1.0], 'pushes.radius': [0.4],
    'pin_moves.start': [0.0], 'pin_moves.node': ['top_left'],
    'pin_moves.target': [-0.4, 0.5, 1.0]}
PLAIN = {**SPRINGS, 'rows': 6, 'cols': 6, 'dt': 0.002}


@pytest.fixture(scope='module')
def context():
    """Return one context for all lists."""
    context = Context(single_thread=True)
    yield context
    context.close()


def words(listed):
    """Return shader and choices of each pass."""
    return {(each['shader'], modelled(each['defines'])) for each in listed['passes']}


class OnlyShear(MassSpring):
    """A mode that takes shear edges alone, whatever the scene has."""

    @staticmethod
    def edge_families(scene):
        """Return those."""
        return {'shear'}


def test_edges_are_those_that_the_mode_takes(monkeypatch):
    """A mode that nobody has thought of here would be measured without edges that it has."""
    monkeypatch.setitem(AVAILABLE, 'mass_spring', OnlyShear)
    no_springs = {**PLAIN, 'stiffness.shear': 0.0, 'damping.shear': 0.0}
    assert has_feature(no_springs, 'shear springs')
    assert not has_feature({**PLAIN, 'stiffness.bend': 10.0}, 'bend springs')


@pytest.mark.parametrize('feature', SCENE_FEATURES)
def test_a_feature_that_is_left_out_is_not_there(feature):
    """What is measured would not be the feature."""
    assert has_feature(FULL, feature)
    less = without(FULL, feature)
    assert not has_feature(less, feature)
    assert all(has_feature(less, other) for other in SCENE_FEATURES if other != feature)
    Scene(less)


@pytest.mark.parametrize('family', ['bend', 'shear'])
@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive', 'constraint'])
def test_springs_that_are_left_out_are_in_no_pass(context, family, mode):
    """A scene would pay for springs that it has not."""
    values = {**PLAIN, 'mode': mode, 'constraint.hard': ['structural', 'shear', 'bend']}
    whole = pass_list(values, context=context)
    less = pass_list(without(values, f'{family} springs'), context=context)
    assert any(family in each for _, each in words(whole))
    assert not any(family in each for _, each in words(less))
    assert len(less['passes']) == len(whole['passes'])


def test_no_damping_is_in_no_pass(context):
    """A scene would pay for damping that it has not."""
    less = pass_list(without(PLAIN, 'damping'), context=context)
    assert not any('damping' in each for _, each in words(less))


@pytest.mark.parametrize(('mode', 'own'), [
    ('constraint', 'solver/product.comp'), ('adaptive', 'strain_watch.comp')])
def test_passes_and_memory_of_a_mode_go_with_it(context, mode, own):
    """A scene would pay for constraints that it has not."""
    values = {**PLAIN, 'mode': mode}
    whole, less = (pass_list(each, context=context) for each in (values, without(values, 'mode')))
    assert own in {shader for shader, _ in words(whole)}
    assert {shader for shader, _ in words(less)} == {
        'mass_spring_step.comp', 'bounds_check.comp', 'observe.comp'}
    assert less['buffer_bytes'] < whole['buffer_bytes']
    assert less['buffers'] < whole['buffers']


def test_pushes_have_no_memory_and_no_program_of_their_own(context):
    """A scene without pushes would have memory for them, or the first push would compile."""
    values = {name: value for name, value in FULL.items() if name != 'mode'}
    whole, less = (
        pass_list(each, context=context) for each in (values, without(values, 'pushes')))
    assert words(less) == words(whole)
    assert less['buffers'] == whole['buffers'] - 1


def test_all_that_is_off_leaves_a_plain_cloth(context):
    """Parameters of what is off would still cost something."""
    plain = pass_list(PLAIN, context=context)
    off = pass_list({
        **PLAIN, 'adaptive.scheme': 'paper', 'solver.tolerance': 1e-5, 'constraint.strain': 1e-2,
        'pin_speed': 3.0, 'adaptive.threshold': 0.01}, context=context)
    assert plain['passes'] == off['passes']
    assert plain['buffer_bytes'] == off['buffer_bytes']


def test_runs_of_a_step_are_its_substeps(context):
    """The table would tell more or less work than is done."""
    listed = pass_list({**PLAIN, 'auto_substeps': False, 'substeps': 7}, context=context)
    runs = {each['shader']: each['runs_per_step'] for each in listed['passes']}
    assert runs == {'mass_spring_step.comp': 7, 'bounds_check.comp': 1, 'observe.comp': 0}
    assert '| mass_spring_step.comp | damping, structural, shear, bend | 7 |' in (
        pass_table(listed))


def test_the_report_tells_what_is_gone(context):
    """The page would show a difference that is not there, or none."""
    whole = pass_list(FULL, context=context)
    others = {name: pass_list(without(FULL, name), context=context)
              for name in ('mode', 'bend springs')}
    text = passes_report(whole, others, ['damping'])
    assert '| mode | gone: strain_watch.comp' in text
    assert '| bend springs | without bend: mass_spring_step.comp' in text
    assert '| damping | not in this scene' in text
