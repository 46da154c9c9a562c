# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Forces over frames: whatever a frame is, their impulses add up to what the momentum lost."""

from contextlib import closing

from abandoned import abandon
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

SCENE = {
    'rows': 8, 'cols': 8, 'dt': 0.002, 'pins': ['0,0'], 'start.z': 0.05, 'air.density': 0.0,
    'colliders.names': ['floor'], 'colliders.floor.shape': 'plane'}
HUNG = {name: value for name, value in SCENE.items() if not name.startswith('colliders')}
MODES = ('mass_spring', 'constraint', 'adaptive')


def impulse(forces):
    """Return the impulse of the cloth in a frame on all that holds or touches it [N s], (3,)."""
    bodies = [body.force for body in (*forces.grasps, *forces.contacts)]
    return forces.seconds * (forces.pins.forces.sum(axis=0) + np.sum(bodies, axis=0))


def momentum(simulation):
    """Return the momentum of the cloth [kg m/s], (3,)."""
    masses = simulation.scene.node_mass * simulation.scene.node_shares[..., None]
    return np.sum(masses * simulation.velocities(), axis=(0, 1))


@pytest.mark.parametrize('mode', MODES)
def test_frames_of_any_length_add_up(context, mode):
    """What is pinned, grasped, moved or let go within a frame would be lost, or count twice."""
    with closing(Simulation(Scene({**SCENE, 'mode': mode}), context=context)) as simulation:
        short, long = simulation.open_force_window(), simulation.open_force_window()
        changes = {
            5: lambda: simulation.pin(7, 7), 9: lambda: simulation.release(7, 7),
            12: lambda: simulation.grasp(
                'gripper', simulation.positions()[0, 7].astype(float), radius=0.15),
            15: lambda: simulation.move_grasp(
                'gripper', np.array(simulation.grasps[0].pose.position) + (0.0, 0.0, 0.05),
                speed=0.5),
            20: lambda: simulation.release_grasp('gripper'),
            24: lambda: simulation.set_mode('mass_spring')}
        taken = {short: np.zeros(3), long: np.zeros(3)}
        begun = momentum(simulation)
        for frame in range(30):
            simulation.step(1 + frame % 7)
            changes.get(frame, lambda: None)()
            taken[short] += impulse(simulation.frame_forces(short))
            if frame % 5 == 4:
                taken[long] += impulse(simulation.frame_forces(long))
        weight = simulation.scene.mass * np.array(simulation.scene['gravity'])
        lost = begun - momentum(simulation) + simulation.time * weight
        for given in taken.values():
            assert np.abs(given - lost).max() <= 1e-5 * np.linalg.norm(lost)


@pytest.mark.parametrize('mode', MODES)
def test_a_frame_is_the_mean_of_its_steps(context, mode):
    """A frame of several steps would be that of its last one; so would its peak."""
    with closing(Simulation(Scene({**SCENE, 'mode': mode}), context=context)) as simulation:
        simulation.grasp('gripper', simulation.positions()[0, 7].astype(float), radius=0.15)
        window = simulation.open_force_window()
        steps = []
        for _ in range(5):
            simulation.step()
            pins, grasps = simulation.pin_forces(), simulation.grasp_forces()
            steps.append((pins.forces[0], pins.peaks[0], grasps[0].force, grasps[0].peak))
        frame = simulation.frame_forces(window)
        assert frame.seconds == pytest.approx(5 * simulation.dt)
        assert frame.pins.nodes.tolist() == [[0, 0]]
        force, peaks, held, held_peaks = (np.array(each) for each in zip(*steps))
        np.testing.assert_allclose(frame.pins.forces[0], force.mean(axis=0), rtol=1e-5, atol=1e-7)
        np.testing.assert_allclose(
            frame.grasps[0].force, held.mean(axis=0), rtol=1e-5, atol=1e-7)
        strongest = np.argmax(np.linalg.norm(peaks, axis=-1))
        np.testing.assert_allclose(frame.pins.peaks[0], peaks[strongest], rtol=1e-6)
        strongest = np.argmax(np.linalg.norm(held_peaks, axis=-1))
        np.testing.assert_allclose(frame.grasps[0].peak, held_peaks[strongest], rtol=1e-6)


def test_steps_at_once_are_as_one_by_one(context):
    """A force would depend on how many steps a caller makes in a call."""
    scene = Scene({
        'rows': 6, 'cols': 5, 'mode': 'mass_spring', 'dt': 0.002, 'air.density': 0.0,
        'pins': ['top_edge', '3,2']})
    found = []
    for calls in ((130,), (1,) * 130, (7, 64, 59)):
        with closing(Simulation(scene, context=context)) as simulation:
            window = simulation.open_force_window()
            for count in calls:
                simulation.step(count)
            pins, frame = simulation.pin_forces(), simulation.frame_forces(window).pins
            found.append((pins.forces, pins.peaks, frame.peaks))
            total = frame.forces
            np.testing.assert_allclose(total, simulation.frame_forces(window).pins.forces)
    for other in found[1:]:
        assert all(np.array_equal(one, two) for one, two in zip(found[0], other))


def test_a_frame_without_a_step_is_told_again(context):
    """A moment that is sent twice would have other forces the second time."""
    with closing(Simulation(Scene(SCENE), context=context)) as simulation:
        simulation.step(3)
        window = simulation.open_force_window()
        first = simulation.frame_forces(window)
        last = simulation.pin_forces()
        assert np.array_equal(first.pins.forces, last.forces)
        simulation.step(2)
        frame = simulation.frame_forces(window)
        assert simulation.frame_forces(window) is frame
        simulation.close_force_window(window)


def test_nothing_has_a_force_before_the_first_step(context):
    """A pin would feel a force of no time."""
    with closing(Simulation(Scene(SCENE), context=context)) as simulation:
        assert not simulation.pin_forces().forces.any()
        simulation.step()
        simulation.pin(7, 7)
        pins = simulation.pin_forces()
        assert pins.nodes.tolist() == [[0, 0], [7, 7]]
        assert pins.forces[0].any() and not pins.forces[1].any()


@pytest.mark.parametrize('mode', MODES)
def test_the_peak_is_no_weaker_than_the_mean(context, mode):
    """A gripper would measure less than it has to hold."""
    values = {**SCENE, 'mode': mode, 'dt': 0.01, 'auto_substeps': False, 'substeps': 16}
    with closing(Simulation(Scene(values), context=context)) as simulation:
        simulation.grasp('gripper', simulation.positions()[0, 7].astype(float), radius=0.2)
        simulation.step(8)
        pins, (grasp,) = simulation.pin_forces(), simulation.grasp_forces()
        means = np.linalg.norm(pins.forces, axis=-1)
        assert np.all(np.linalg.norm(pins.peaks, axis=-1) >= means * (1.0 - 1e-6))
        assert np.linalg.norm(grasp.peak) >= np.linalg.norm(grasp.force)
        held = simulation.grasped_nodes()[tuple(pins.nodes.T)]
        np.testing.assert_allclose(pins.forces[held].sum(axis=0), grasp.force)
        assert np.linalg.norm(grasp.peak) <= np.linalg.norm(
            pins.peaks[held], axis=-1).sum() * (1.0 + 1e-6)


def test_steps_that_are_undone_leave_no_impulse(context):
    """A step that was abandoned would count once more when it is made."""
    values = {**SCENE, 'mode': 'constraint', 'dt': 0.01}
    with closing(Simulation(Scene(values), context=context)) as simulation, closing(
            Simulation(Scene(values), context=context)) as twin:
        windows = simulation.open_force_window(), twin.open_force_window()
        for run in (simulation, twin):
            run.step(3)
        abandon(simulation, steps=2, after=9)
        twin.engines.forget()
        for run in (simulation, twin):
            run.step(2)
        frames = [
            run.frame_forces(window) for run, window in zip((simulation, twin), windows)]
        assert np.array_equal(frames[0].pins.forces, frames[1].pins.forces)
        assert np.array_equal(frames[0].pins.peaks, frames[1].pins.peaks)


# Scenes whose pins are recorded by programs of their own.
RECORDED = {
    **{mode: {**SCENE, 'mode': mode} for mode in MODES},
    'two passes': {**HUNG, 'mode': 'mass_spring', 'layout': 'paper'},
    'paper limit': {**HUNG, 'mode': 'adaptive', 'adaptive.scheme': 'paper'},
    'bending': {
        **HUNG, 'mode': 'mass_spring', 'bending.rigidity': 1e-4, 'bending.damping': 0.01,
        'stiffness.bend': 0.0},
    'low parts': {
        **HUNG, 'mode': 'mass_spring', 'dt': 1e-6, 'start.z': 5.0}}


@pytest.mark.parametrize('name', RECORDED)
def test_recording_leaves_the_state_as_it_is(context, name):
    """Who looks at forces would see another motion, by other programs."""
    scene, found = Scene(RECORDED[name]), []
    for records in (False, True):
        with closing(Simulation(scene, context=context, records_forces=False)) as simulation:
            if records:
                simulation.open_force_window()
            simulation.step(40)
            simulation.move_pin(0, 0, (0.0, 0.0, 0.3), speed=1.0)
            simulation.step(60)
            assert simulation.knows_forces == records
            found.append((simulation.positions(), simulation.velocities()))
    assert np.abs(found[0][1]).max() > 0.0
    assert all(np.array_equal(one, two) for one, two in zip(*found))


@pytest.mark.parametrize('mode', MODES)
def test_the_last_step_is_recorded_in_any_call(context, mode):
    """A force would be one of an earlier step, or none, after many steps in a call."""
    scene = Scene({**SCENE, 'mode': mode, 'pins': ['top_edge']})
    found = []
    for calls in ((70,), (1,) * 70, (33, 37), (69, 1)):
        with closing(Simulation(scene, context=context)) as simulation:
            for count in calls:
                simulation.step(count)
            pins = simulation.pin_forces()
            found.append((pins.forces, pins.peaks))
            assert np.abs(pins.forces).max() > 0.0
    for other in found[1:]:
        assert all(np.array_equal(one, two) for one, two in zip(found[0], other))


def test_forces_that_were_not_recorded_are_refused(context):
    """A force of 0 would be reported where none was recorded."""
    with closing(Simulation(
            Scene(SCENE), context=context, records_forces=False)) as simulation:
        assert not simulation.pin_forces().forces.any()
        simulation.step(3)
        window = simulation.open_force_window()
        for read in (
                simulation.pin_forces, simulation.grasp_forces,
                lambda: simulation.frame_forces(window)):
            with pytest.raises(ClothSimError, match='records_forces=True'):
                read()
        snapshot = simulation.snapshot(tension=True)
        assert snapshot.tension is not None and snapshot.pin_forces is None
        simulation.step(2)
        frame, last = simulation.frame_forces(window), simulation.pin_forces()
        assert frame.seconds == pytest.approx(2 * simulation.dt)
        assert frame.pins.forces.any() and last.forces.any()
        simulation.close_force_window(window)
        simulation.step()
        assert not simulation.knows_forces


def test_steps_that_nobody_can_read_record_nothing(context):
    """All steps would take the time that recording takes, for the last one's sake."""
    scene = Scene({**HUNG, 'mode': 'mass_spring'})
    with take_inventory() as inventory, closing(
            Simulation(scene, context=context)) as simulation:
        simulation.step(50)
        substeps = simulation.substeps
    runs = {
        program.source.used_defines['HAS_HELD']: program.dispatches
        for program in inventory.programs if program.name == 'mass_spring_step.comp'}
    assert runs == {0: 49 * substeps, 1: substeps}


def test_forces_of_steps_made_again_are_known(context):
    """After a blow-up, the forces of the last finite step would be lost with the others."""
    values = {
        **HUNG, 'mode': 'mass_spring', 'auto_substeps': False, 'substeps': 1}
    with closing(Simulation(
            Scene(values), context=context, check_stability=False)) as simulation:
        with pytest.raises(NonFiniteStateError):
            simulation.step(2000)
        assert simulation.steps > 1
        assert simulation.pin_forces().forces.any()
