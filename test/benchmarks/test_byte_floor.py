# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The least bytes of a pass are those of the fields that it loads and stores."""

from byte_floor import floor_ratios
from byte_floor import SolverPasses
from byte_floor import SYSTEM_FIELDS
from byte_floor import TRAFFIC
from byte_floor import Traffic
from byte_floor import VECTOR_FIELDS
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.study.solver_speed import unit_scene
import numpy as np
import pytest

SIZE = 16
COARSE_FIELDS = 10


@pytest.fixture(scope='module')
def passes():
    """Make the passes with all that a solve loads: edges that come to limits as well."""
    context = Context(single_thread=True)
    law = edge_law(
        unit_scene(SIZE), 0.01, limited=('structural', 'shear'), limit=0.001, geometric=0.5)
    made = SolverPasses(SIZE, context, law)
    yield made
    made.delete()
    context.close()


class Memory:
    """All fields that passes load and store, by name."""

    def __init__(self, passes):
        """Find the nodes of cloth and next level among what is stored."""
        large = passes.buffers._allocated()
        self._buffers = large.vectors, large.system
        self._state = passes.state
        self._layouts = passes.levels.layouts[:2]

    def read(self):
        """Return the bits of each field, (nodes, 3 or 4), and the raw buffers."""
        vectors, system = (np.empty((b.bytes // 16, 4), np.float32) for b in self._buffers)
        for buffer, values in zip(self._buffers, (vectors, system)):
            buffer.read_into(values)
        cloth, coarse = self._layouts
        fields = {
            name: self._field(vectors, cloth, 0, place)[..., :3]
            for place, name in enumerate(VECTOR_FIELDS)}
        fields |= {
            name: self._field(system, cloth, 0, place) for place, name in enumerate(SYSTEM_FIELDS)}
        begin = cloth.stored * len(SYSTEM_FIELDS)
        fields |= {
            f'coarse {place}': self._field(system, coarse, begin, place)
            for place in range(COARSE_FIELDS)}
        fields['position'] = self._state.read_positions()
        fields['velocity'] = self._state.read_velocities()
        return fields, (vectors, system)

    def write(self, raw, state):
        """Put everything back."""
        for buffer, values in zip(self._buffers, raw):
            buffer.write(values)
        self._state.write(*state)

    def changed(self, names, fields, raw):
        """Return the raw buffers and the state with more in the fields ``names``."""
        state = [fields['position'].copy(), fields['velocity'].copy()]
        raw = [values.copy() for values in raw]
        random = np.random.default_rng(3)
        for values, name in zip(state, ('position', 'velocity')):
            if name in names:
                values += random.uniform(0.1, 0.2, values.shape)
        for values, places in zip(raw, (VECTOR_FIELDS, SYSTEM_FIELDS)):
            for place, name in enumerate(places):
                if name in names:
                    field = self._field(values, self._layouts[0], 0, place)
                    # What a node is stands in the fourth number.
                    field = field[..., :3] if name == 'NODE' else field
                    field += random.uniform(0.1, 0.2, field.shape)
        return raw, state

    @staticmethod
    def _field(values, layout, begin, place):
        first = begin + place * layout.stored
        return layout.load(values[first:first + layout.stored])


def outcome(passes, memory, run, raw, state):
    """Return all fields after the pass has run on these."""
    memory.write(raw, state)
    passes.bind()
    run()
    fields, _ = memory.read()
    return {**fields, 'sums': np.array(passes.buffers.sums())}


@pytest.mark.parametrize(
    'name', ['right side', 'assembly', 'coarsening', 'smoothing', 'product', 'update'])
def test_fields_are_those_that_the_shader_loads_and_stores(passes, name):
    """The floor would be that of another pass, or of one as it once was."""
    memory, run = Memory(passes), passes.passes[name]
    fields, raw = memory.read()
    # None is zero, which would hide its factor.
    memory.write(*memory.changed(fields, fields, raw))
    before, raw = memory.read()
    after = outcome(passes, memory, run, raw, (before['position'], before['velocity']))
    stores = {key for key in before if not np.array_equal(after[key], before[key])}
    loads = set()
    for field in before:
        other = outcome(passes, memory, run, *memory.changed([field], before, raw))
        if any(not np.array_equal(other[key], after[key]) for key in (*stores, 'sums')):
            loads.add(field)
    memory.write(raw, (before['position'], before['velocity']))
    traffic = TRAFFIC[name]
    assert stores == traffic.stores | traffic.coarse
    assert loads == traffic.loads


def test_bytes_are_counted_once_each():
    """A field would count for each of the nodes that look at it, or the next level as a cloth."""
    traffic = Traffic(frozenset({'a', 'b'}), frozenset({'a'}), frozenset({'c'}), sums=2)
    assert traffic.moved_bytes(100, 25, 7) == 16 * (300 + 25 + 14)
    assert TRAFFIC['substep of mass_spring'].moved_bytes(1, 0, 0) == 64


def test_each_pass_has_a_ratio():
    """A row would be missing, or the copy would move other bytes."""
    ratios = list(floor_ratios((8,), (12,), 2, 1e-3))
    assert [each.name for each in ratios] == [
        'substep of mass_spring', 'right side', 'assembly', 'coarsening', 'smoothing', 'product',
        'reduction', 'update']
    assert all(each.ratio > 0.0 and len(each.ratios) == 2 for each in ratios)
    assert ratios[0].least_bytes == 64 * 64
