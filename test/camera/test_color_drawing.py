# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures have the colours, the fabric and the shadows that the scene asks for."""

from cloth_sim_ros.camera.rig import CameraRig
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from PIL import Image
import pytest
from seen_cloths import FALLING
from seen_cloths import plane_cloth
from seen_cloths import snapshot_of

ABOVE = {'position': [0.0, 0.0, 2.0], 'target': [0.0, 0.0, 0.0], 'width': 160, 'height': 120}
CLOTH = plane_cloth((-0.3, 0.3, 0.3), (0.6, 0.0, 0.0), (0.0, -0.6, 0.0), 9, 9)
GROUND = Collider('ground', 'plane', (), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 0.3)
RED, GREEN = (0.9, 0.1, 0.1), (0.1, 0.8, 0.1)


def mean_color(picture, label):
    """Return the mean colour of what has a label, (3,) from 0 to 1."""
    return picture.color[picture.labels == label].mean(axis=0) / 255.0


def test_each_side_has_its_color(camera):
    """A folded corner would look like the rest of the cloth."""
    eye = camera(**ABOVE)
    look = Look(color=RED, back_color=GREEN, sun=(0.0, 0.0, 1.0))
    front = mean_color(eye.capture(snapshot_of(CLOTH), look=look), 1)
    back = mean_color(eye.capture(snapshot_of(CLOTH[:, ::-1]), look=look), 1)
    assert front[0] > 3.0 * front[1] and back[1] > 3.0 * back[0]


def test_bodies_and_background_have_their_colors(camera):
    """A data set would show the same table in each picture."""
    eye = camera(**ABOVE)
    ball = Collider('ball', 'sphere', (0.2,), (0.0, 0.0, 0.6), (0.0, 0.0, 0.0, 1.0), 0.3)
    look = Look(background=(0.2, 0.4, 0.6), bodies={'ball': GREEN})
    picture = eye.capture(snapshot_of(CLOTH), colliders=[ball], look=look)
    np.testing.assert_allclose(mean_color(picture, 0), (0.2, 0.4, 0.6), atol=0.02)
    assert mean_color(picture, 2)[1] > 3.0 * mean_color(picture, 2)[0]


def test_the_sun_casts_the_shadow_where_it_falls(camera):
    """A shadow would say that the cloth is somewhere else."""
    eye = camera(**ABOVE)
    # By half a metre to the side for each metre of height.
    look = Look(sun=(0.5, 0.0, 1.0), shadow=0.002)
    picture = eye.capture(snapshot_of(CLOTH), colliders=[GROUND], look=look)
    world = picture.pose.in_world(picture.points().astype(float))
    light = picture.color.astype(float).mean(axis=-1)
    on_ground = picture.labels == 2
    x, y = world[..., 0] + 0.15, world[..., 1]
    inside = on_ground & (np.abs(x) < 0.27) & (np.abs(y) < 0.27)
    outside = on_ground & ((np.abs(x) > 0.33) | (np.abs(y) > 0.33))
    assert inside.sum() > 50
    assert light[inside].max() < 0.85 * light[outside].min()


def test_outlines_are_smooth_unless_there_is_one_sample(camera):
    """A detector would learn the stairs of an outline, or pay for what it does not see."""
    look = Look(color=(0.0, 0.0, 0.0), back_color=(0.0, 0.0, 0.0), background=(1.0, 1.0, 1.0))
    tilted = plane_cloth((-0.3, 0.3, 0.3), (0.55, 0.11, 0.0), (0.11, -0.55, 0.0))
    between = {}
    for samples in (1, 4):
        color = camera(**ABOVE, samples=samples).capture(snapshot_of(tilted), look=look).color
        light = color.mean(axis=-1)
        between[samples] = int(((light > 80) & (light < 230)).sum())
    assert between[1] == 0 and between[4] > 50


@pytest.mark.parametrize('fabric', ['checked', 'woven'])
def test_a_pattern_has_its_pitch_on_the_cloth(camera, fabric):
    """Checks would be of another size than the fabric has them."""
    eye = camera(**{**ABOVE, 'width': 480, 'height': 360, 'field_of_view': 40.0})
    look = Look(
        fabric=fabric, color=(0.1, 0.1, 0.1), second_color=(0.9, 0.9, 0.9), pitch=0.06,
        sun=(0.0, 0.0, 1.0))
    picture = eye.capture(snapshot_of(CLOTH), look=look)
    line = picture.color.astype(float).mean(axis=-1)[175:185].mean(axis=0)
    on_cloth = (picture.labels[175:185] == 1).all(axis=0)
    line = line[on_cloth] - line[on_cloth].mean()
    # Two checks, or two threads, are a period: five in 0.6 m.
    spectrum = np.abs(np.fft.rfft(line))[1:]
    assert np.argmax(spectrum) + 1 in ((5,) if fabric == 'checked' else (5, 10))


def test_colors_are_those_of_the_labels(camera, fallen):
    """Labels would be off the picture by some pixels."""
    eye = camera(position=[1.5, 0.3, 1.2], target=[0.0, 0.0, 0.2], width=320, height=240)
    look = Look(color=(1.0, 0.0, 0.0), back_color=(1.0, 0.0, 0.0), bodies={
        'ball': (0.0, 1.0, 0.0), 'ground': (0.0, 0.0, 1.0)})
    picture = eye.capture(fallen, look=look)
    labels = np.array([3, 1, 2, 3])[picture.labels]
    # What is seen next to an outline is a mean of both.
    inner = np.ones(labels.shape, bool)
    for shift in ((0, 1), (1, 0), (0, -1), (-1, 0)):
        inner &= np.roll(labels, shift, (0, 1)) == labels
    seen = picture.color.argmax(axis=-1) + 1
    assert inner.mean() > 0.9 and (seen[inner] == labels[inner]).mean() > 0.9999


def test_a_print_lies_on_the_front_along_row_0(camera, tmp_path):
    """A logo would be upside down, mirrored, or on the wrong side."""
    quarters = np.zeros((40, 40, 3), np.uint8)
    quarters[:20, :20], quarters[:20, 20:] = (255, 0, 0), (0, 255, 0)
    quarters[20:, :20], quarters[20:, 20:] = (0, 0, 255), (255, 255, 255)
    Image.fromarray(quarters).save(tmp_path / 'print.png')
    look = Look(texture=str(tmp_path / 'print.png'), back_color=(0.5, 0.5, 0.5))
    eye = camera(**ABOVE)
    picture = eye.capture(snapshot_of(CLOTH), look=look)
    # Seen from above with y up: row 0 is above in the picture, column 0 to the left.
    rows, cols = np.nonzero(picture.labels == 1)
    top, left = rows.min(), cols.min()
    side = np.ptp(rows) // 4
    found = picture.color[[[top + side], [top + 3 * side]], [left + side, left + 3 * side]]
    assert found.argmax(axis=-1)[:, 0].tolist() == [0, 2] and found[0, 1].argmax() == 1
    assert np.ptp(found[1, 1].astype(int)) < 30 and found[1, 1].min() > 150
    back = eye.capture(snapshot_of(CLOTH[:, ::-1]), look=look)
    seen = back.color[back.labels == 1].astype(int)
    assert np.percentile(np.ptp(seen, axis=-1), 95.0) < 10


def test_a_backdrop_fills_what_nothing_is_before(camera, tmp_path):
    """A data set would have walls of one colour, or a backdrop over its cloth."""
    halves = np.zeros((30, 40, 3), np.uint8)
    halves[:15, :, 0], halves[15:, :, 2] = 255, 255
    Image.fromarray(halves).save(tmp_path / 'room.png')
    eye = camera(**ABOVE)
    look = Look(backdrop=str(tmp_path / 'room.png'), color=GREEN)
    picture = eye.capture(snapshot_of(CLOTH), look=look)
    background = picture.labels == 0
    assert (picture.color[:50][background[:50]].argmax(axis=-1) == 0).all()
    assert (picture.color[70:][background[70:]].argmax(axis=-1) == 2).all()
    assert mean_color(picture, 1).argmax() == 1


def test_a_missing_picture_is_named(camera, tmp_path):
    """The cloth would be black, or the run end in a traceback."""
    eye = camera(**ABOVE)
    (tmp_path / 'text.png').write_text('no picture')
    for given, rule in (
            ({'texture': 'nowhere.png'}, 'look.texture: there is no file nowhere.png: give an'),
            ({'backdrop': str(tmp_path / 'text.png')}, 'look.backdrop .* is no picture')):
        with pytest.raises(ClothSimError, match=rule):
            eye.capture(snapshot_of(CLOTH), look=Look(**given))
    values = {**FALLING, 'cameras.names': ['eye'], 'cameras.eye.position': [1.0, 0.0, 1.0],
              'cameras.eye.target': [0.0, 0.0, 0.0], 'look.texture': 'nowhere.png'}
    with Simulation(Scene(values)) as simulation:
        with pytest.raises(ClothSimError, match='there is no file nowhere.png'):
            CameraRig(simulation, lambda _: None)


@pytest.mark.parametrize('wrong, rule', [
    ({'look.color': [0.5, 0.5]}, 'look.color needs red, green and blue'),
    ({'look.color': [0.5, 0.5, 2.0]}, 'look.color 2.0 is outside its range'),
    ({'look.sun': [0.0, 0.0, 0.0]}, 'look.sun needs a direction'),
    ({'look.fabric': 'silk'}, 'must be one of plain, checked, woven'),
    ({'look.pitch': 0.0}, 'outside its range'),
    ({'colliders.ball.color': [1.0]}, 'colliders.ball.color needs red'),
])
def test_wrong_looks_are_refused(wrong, rule):
    """The picture would be black, and nobody told why."""
    with pytest.raises(ClothSimError, match=rule):
        Scene({**FALLING, **wrong})
