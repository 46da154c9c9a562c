# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contact of the cloth with itself in a substep, docs/explanation/self_contact.md."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import dataclass
import math
import struct
import warnings

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import BufferRow
from cloth_sim_ros.gl.buffer import shader_dispatches_visible
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.buffer import writes_visible_call
from cloth_sim_ros.gl.context import refuse_lost_context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.program import MOST_GROUPS
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import HALO
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.device.scene_program import Strips
from cloth_sim_ros.sim.model.colliders import mask_of
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import SubstepEnds
import numpy as np

# Invocations of a workgroup of the passes over pairs, contacts and nodes [1].
_LOCAL = 32
# Contacts that an invocation looks at before rounds [1], on software; chosen: with 4 a folded
# towel takes 2 % longer, with 1 13 % (cloth_sim bench --layers --sizes 64 --rounds 3).
_CONTACTS_OF_SOFTWARE = 16
# Pairs that an invocation looks at for contacts [1], on software; chosen: from 8 to 32 a moving
# towel takes the same time to 10 % (cloth_sim bench --layers).
_PAIRS_OF_SOFTWARE = 16
# Passes read the state through textures on all devices: they write into many storage blocks.
_READS = {'LOADS_TEXTURE': 1}
# Rounds of impulses between two looks at how they change, and at most in a substep [1]; chosen:
# with at most 32 a cloth twisted twice keeps 0.95 of its thickness instead of 0.92; with three
# between looks a sheet slips by 2e-6 m instead of 1e-7 m at 0.99 of the friction limit
# (test_self_contact.py).
_ROUNDS, _MOST_ROUNDS = 4, 8
# Rounds between two looks [1], before a solve of an implicit step, which costs more than rounds;
# chosen: from 2 to 24 less changes than by half the tolerance, solves by 1 %
# (constants.py --only _ROUNDS_OF_SOLVE).
_ROUNDS_OF_SOLVE = 8
# Max. of them before a solve [1].
_MOST_ROUNDS_OF_SOLVE = 24
# Change of a velocity in a round over the largest impulse [1], at which they end; chosen: at rest
# it is 0.01 to 0.05 after four rounds.
_STILL = 0.1
# Reach of the lists beyond the thickness: the largest of this many thicknesses, parts of a cell,
# and displacements of a substep [1]; chosen: from 1 to 2 thicknesses a moving towel takes the same
# time to 10 % (cloth_sim bench --layers).
_SKIN, _SKIN_OF_CELL, _SKIN_OF_WAY = 1.5, 0.1, 4.0
# Reach over the displacement of an implicit substep [1], so that lists last for several;
# chosen: same bits from 4 to 16, time -13 to 0 % (constants.py --only _SKIN_OF_LONG_WAY).
_SKIN_OF_LONG_WAY = 8.0
# Max. of it, in parts of a cell [1]: nodes that would go farther are stopped, as more pairs are
# near then than memory has room for.
_MOST_SKIN_OF_CELL = 2.0
# Displacement, as a fraction of half of that, after which lists are made anew [1]; the rest is
# what contact may add in a substep.
_USED = 0.9
# Max. substeps without a look at displacements, while no pair is near [1], and how many times
# faster nodes may become meanwhile [1]; if they went too far, the next look counts crossings.
_MOST_UNLOOKED, _FASTER = 16, 4.0
# Max. number of explicit substeps that contacts serve before they are found anew [1].
_MOST_WINDOW = 16
# Max. displacement meanwhile, over a cell and over the thickness [1]: points that touch are those
# of the first substep; chosen: from (0.05, 0.2) to (0.1, 0.4) the figures of
# test_self_contact.py stay, and a moving towel takes 12 % less time (cloth_sim bench --layers).
_WINDOW_OF_CELL, _WINDOW_OF_THICKNESS = 0.1, 0.4
# Displacement since lists were made, as a fraction of half the reach [1], at which a node is
# stopped; the rest is rounding.
_ROOM = 0.98
# Fraction of a gap that is left in a substep [1], as in guard.comp, and rounding of a displacement
# over the largest coordinate [1].
_LEFT, _ROUNDING = 0.2, 4e-7
# Thickness between two edges over that between a node and a triangle [1]: flat layers lie on their
# nodes, and edges act where they come nearer. Chosen by test_self_contact.py -k "four_layers or
# incline": with 0.9995 a stack comes to rest within 8e-8 m/s instead of 2e-8, and a sheet slides
# by up to 1.1 % too far instead of 0.8 %, as with 0.998.
_OF_EDGES = 0.999
# The same where solves act, where edges carry flat layers. Chosen likewise: with 0.999, 0.9995 and
# 0.9998 four layers are 0.0030, 0.0015 and 0.0006 of a thickness too low instead of 0.0003; nearer
# to 1 the difference would be near the rounding of positions.
_OF_EDGES_IN_SOLVES = 0.9999
# Distance over the thickness [1] below which crossings are counted: with a thickness of 1 mm, ten
# times what positions near 1 m are rounded by.
_DOUBTFUL = 1e-3
# Pairs that there is room for at first, over nodes [1]; it grows.
_PAIRS = 4
# Size of an entry of each kind in the shaders [bytes].
_PAIR_BYTES, _CONTACT_BYTES, _NODE_BYTES, _BOX_BYTES = 16, 64, 48, 32
# The same of a contact that acts, and of its entry at each of four nodes.
_ACTING_BYTES, _ENTRY_BYTES = 16, 8
# Range of the sums of impulses over the speed in a substep [1], as in contacts.glsl, and the least
# such speed [m/s].
_SUM_RANGE, _LEAST_SPEED = 4096.0, 1e-9
# Entry of a node with the fraction of its displacement that is left by the guard [1].
_CUT = 7
# Range of the ways out of layers over the fastest [1], as in round.comp.
_WAY_RANGE = 64.0 / 2.0**31
# The head of head.glsl, as a substep begins.
_LEAST = 0xFFFFFFFF
_HEAD = np.dtype([
    ('contact_groups', '3u4'), ('contact_count', 'u4'), ('node_groups', '3u4'),
    ('self_node_count', 'u4'), ('acting_groups', '3u4'), ('acting_count', 'u4'),
    ('entry_count', 'u4'), ('least_distance', 'f4'),
    ('least_moved', '3u4'), ('most_moved', '3u4'), ('least_speed', '3u4'),
    ('most_speed', '3u4'), ('vertex_pairs', 'u4'), ('edge_pairs', 'u4'), ('cut_nodes', 'u4'),
    ('largest_cut', 'f4'), ('longest_way', 'f4'), ('largest_impulse', 'f4'),
    ('largest_change', 'f4'), ('undivided', 'u4'), ('unfinished', 'u4'), ('largest', 'f4'),
    ('crossing_edges', 'u4'), ('first_crossing', 'u4'), ('cut_pins', 'u4'),
    ('largest_drive', 'f4')])
_FIRST_ROUND, _LAST_ROUND = 1, 2
_NOWHERE = 0.0, 0.0, 0.0
# What wake.comp looks at.
_FOUND, _ASLEEP, _AGAIN = range(3)


def _place(name: str) -> int:
    """Return the offset of a field of the head [bytes]."""
    fields = _HEAD.fields
    assert fields is not None
    return fields[name][1]


_CONTACT_GROUPS, _NODE_GROUPS, _ACTING_GROUPS = (
    _place(f'{name}_groups') for name in ('contact', 'node', 'acting'))
# Offset of the fields of one substep in the head, after those of the contacts [bytes], and the
# range of the displacements and velocities in it, as numbers of four bytes.
_OF_SUBSTEP = _place('least_moved')
_SPANS = slice(_OF_SUBSTEP // 4, _place('vertex_pairs') // 4)


@dataclass
class SelfContactFigures:
    """
    Result of self-contact in one substep or several.

    :param contacts: pairs that touch or are about to; most of a substep
    :param least_distance: of the pairs examined, between mid-surfaces [m]; infinite for none
    :param cut_nodes: nodes whose displacement was shortened to prevent passing, total
    :param largest_cut: largest shortening of a displacement [m]
    :param undivided: pairs that had passed through each other before; most of a substep
    :param cut_pins: pinned nodes among ``cut_nodes``
    """

    contacts: int = 0
    least_distance: float = math.inf
    cut_nodes: int = 0
    largest_cut: float = 0.0
    undivided: int = 0
    cut_pins: int = 0

    def add(self, other: 'SelfContactFigures') -> None:
        """Add the result of a substep."""
        self.contacts = max(self.contacts, other.contacts)
        self.least_distance = min(self.least_distance, other.least_distance)
        self.cut_nodes += other.cut_nodes
        self.largest_cut = max(self.largest_cut, other.largest_cut)
        self.undivided = max(self.undivided, other.undivided)
        self.cut_pins += other.cut_pins


class SelfContact:
    """
    The passes of shaders/self_contact, and their memory from substep to substep.

    In an implicit substep, solves include the impulses found by rounds, and rounds continue from
    the velocities found by solves.

    :param is_implicit: whether substeps are implicit
    :param may_note: whether ``give`` may be called with ``notes_changes``
    """

    def __init__(
            self, scene: Scene, layout: Layout, *, is_implicit: bool = False,
            may_note: bool = False) -> None:
        """Allocate; passes are compiled when they are first used."""
        self._scene, self._layout = scene, layout
        self._gravity = float(np.linalg.norm(scene['gravity']))
        self._thickness: float = scene['self_contact.thickness']
        self._most_gone = min(
            _WINDOW_OF_CELL * min(scene.spacing), _WINDOW_OF_THICKNESS * self._thickness)
        self._levels = _levels(layout.rows, layout.cols)
        self._programs = _programs(scene, layout, is_implicit=is_implicit, may_note=may_note)
        self._rounds = (
            (_ROUNDS_OF_SOLVE, _MOST_ROUNDS_OF_SOLVE) if is_implicit else (_ROUNDS, _MOST_ROUNDS))
        self._is_implicit = is_implicit
        # Whether passes of thin bodies read the impulses on nodes.
        self._acts_on_surface = bool(scene.thin_colliders) and not is_implicit
        self._skin_of_way = _SKIN_OF_LONG_WAY if is_implicit else _SKIN_OF_WAY
        self._strips = Strips.groups(layout)
        self._pairs_each = _pairs_each(layout)
        self._head = Buffer(_HEAD.itemsize, is_polled=True)
        self._head.write(_fresh_head())
        self._fresh = _fresh_head()
        # The figures of the contacts stay.
        self._of_substep = self._fresh.view(np.uint8)[_OF_SUBSTEP:]
        self._reset = self._head.write_calls(self._of_substep, _OF_SUBSTEP)
        self._fresh_contacts = _fresh_head().view(np.uint8)[:_OF_SUBSTEP].copy()
        self._features = Buffer(layout.store(_owned(scene)).reshape(-1))
        stored = layout.stored
        nothing = np.zeros((stored, 4), dtype=np.float32)
        self._built, self._velocities = Buffer(nothing), Buffer(nothing)
        self._cell_ways = Buffer(nothing)
        self._boxes = Buffer(int(self._levels[:, 0] @ self._levels[:, 1]) * _BOX_BYTES)
        self._first = Buffer(np.zeros(stored, dtype=np.uint32))
        nodes = np.zeros((stored, _NODE_BYTES // 4), dtype=np.uint32)
        nodes[:, _CUT] = np.float32(1.0).view(np.uint32)
        self._nodes = Buffer(nodes)
        self._most_pairs = _PAIRS * scene.node_count
        self._pairs = [Buffer(self._most_pairs * _PAIR_BYTES) for _ in range(2)]
        self._contacts = Buffer(self._most_pairs * _CONTACT_BYTES)
        self._acting = Buffer(self._most_pairs * _ACTING_BYTES)
        self._entries = Buffer(self._entry_bytes())
        self._kept = Buffer(self._most_pairs * _PAIR_BYTES)
        # Impulses on nodes: all that solves have included, and what the next one is to.
        self._applied, self._driven = (
            Buffer(nothing if is_implicit else nothing[:1]) for _ in range(2))
        self._length = 0.0
        # Uniforms of all passes, a number for their present values, and that of each pass.
        self._uniforms: dict[str, float] = {
            'thickness': self._thickness, 'friction': scene['self_contact.friction']}
        self._version = 0
        self._set_for: dict[str, int] = {}
        self._set_colliders_in: Callable[[Program], None] | None = None
        # The calls that bind its buffers, by the name of that of the pairs, and what they need.
        self._binds: dict[int, list[Call]] = {}
        self._rows: list[BufferRow] = []
        # The calls of rounds, by whether they are the first of a substep.
        self._rounds_made: dict[bool, list[Call]] = {}
        # Whether there are contacts on the device.
        self._has_found = False
        self._read = np.zeros(1, dtype=_HEAD)
        self._spans = self._read.view(np.uint32)[_SPANS]
        self._look = self._head.read_calls(self._read)
        self.forget()

    def forget(self) -> None:
        """Drop lists and impulses, which do not belong to the next state."""
        self._reach = 0.0
        self._impulse_unit = 0.0
        # Displacement since contacts were found, in which they may serve, and substeps left.
        self._gone, self._window = 0.0, 0
        self._serves_again = False
        # Edges that pierced triangles at the last count, and whether there may be others by now.
        self._crossings = 0
        self._has_doubts = self._is_new = True
        self._counts = 0, 0
        # Substeps until the next look.
        self._unlooked = 0
        self._common_way: tuple[float, ...] = _NOWHERE
        self._common_moved: tuple[float, ...] = _NOWHERE
        # Whether no round has been made in the substep.
        self._is_first = True
        # Length of the last substep whose impulses solves have included [s]; 0: none has.
        self._applied_for = 0.0
        self._applied.clear()
        self._share_to_keep = 1.0
        # Whether the next solve has impulses to include.
        self.drives = False

    @property
    def crossings(self) -> int:
        """Return how many edges pierced triangles when lists were last made."""
        return self._crossings

    @property
    def has_pairs(self) -> bool:
        """Return whether the current substep may have contacts."""
        return any(self._counts)

    @property
    def impulse_unit(self) -> float:
        """Return the unit of the impulses of nodes in contacts.glsl [m/s]."""
        return self._impulse_unit

    def run_all_passes(self, state: SubstepEnds, held_at: int) -> None:
        """Run each pass once on a substep that is discarded; ``held_at`` as in ``give``."""
        self.find(state, self._scene['dt'])
        self._build(state, self._thickness)
        # Passes over both kinds of pairs, though there may be none.
        self._counts = 1, 1
        self._find_contacts(state)
        self._copy_kept()
        self.begin(state)
        self.let_act()
        for looks in (_ASLEEP, _AGAIN):
            self._wake(looks)
        if self._is_implicit:
            self.drive(state)
        for notes_changes in (False, True):
            if _last_pass(held_at, notes_changes) in self._programs:
                self.give(held_at, notes_changes=notes_changes)
        self.guard(state)
        self._cut(state, 0.0)
        self._clear_contacts()
        self.forget()

    def let_colliders_act(self, set_in: Callable[[Program], None] | None) -> None:
        """
        Let colliders act on nodes in the next substep.

        :param set_in: sets the colliders in a pass that is in use; None for no colliders
        """
        self._set_colliders_in = set_in

    def begin_substep(self, length: float) -> None:
        """Prepare the first solve of a substep of ``length`` [s], with the last impulses."""
        self.drives = self.has_pairs and self._applied_for > 0.0
        if self.drives:
            self._share_to_keep = length / self._applied_for
            self._run_drive(begins=True)
        elif self._applied_for > 0.0:
            self._applied.clear()
        self._applied_for = 0.0

    def bind_driven(self) -> None:
        """Bind the impulses that a solve includes."""
        self._driven.bind_texture(bindings.SELF_DRIVEN)

    def drive(self, ends: SubstepEnds) -> float:
        """Pass the changes by rounds to the next solve; return the largest [m/s]."""
        ends.bind_out_textures()
        self._head.write(np.zeros(1, dtype=np.uint32), _place('largest_drive'))
        self._run_drive(begins=False)
        self._applied_for, self.drives = self._length, True
        return float(self._read_head()['largest_drive'])

    def _run_drive(self, *, begins: bool) -> None:
        for buffer, place in (
                (self._head, bindings.SELF_HEAD), (self._nodes, bindings.SELF_NODES),
                (self._applied, bindings.SELF_APPLIED), (self._driven, bindings.SELF_DRIVEN)):
            buffer.bind_storage(place)
        program = self._use('drive')
        program.set_int('begins', int(begins))
        program.set_float('share', self._share_to_keep)
        program.dispatch(*self._strips)
        shader_writes_visible()

    def find(self, state: SubstepEnds, length: float) -> None:
        """
        Find the contacts of a substep of ``length`` [s].

        Both its states are in ``state``; contact with colliders follows later.
        """
        if self._unlooked > 0:
            self._unlooked -= 1
            # Passes over colliders ask it which nodes are touched.
            self._nodes.bind_texture(bindings.SELF_NODES)
            return
        self._set_length(length)
        self._bind()
        make(self._reset)
        ways = self._use('ways')
        state.bind_in_textures()
        state.bind_out_textures()
        ways.dispatch(*self._strips)
        shader_writes_visible()
        self._read_head()
        least, most, slowest, fastest = _from_order(self._spans.tolist())
        moved = 0.5 * math.dist(most, least)
        way = 0.5 * length * math.dist(fastest, slowest)
        room = 0.5 * _USED * (self._reach - self._thickness)
        if self._reach and not self.has_pairs and moved + way > 0.5 * _ROOM * self._reach:
            # Nodes may have gone farther than the lists allow for, unguarded.
            self._has_doubts = True
        # NaN asks for new lists, which are empty then.
        if not moved <= room:
            cell = min(self._scene.spacing)
            skin = max(_SKIN * self._thickness, _SKIN_OF_CELL * cell, self._skin_of_way * way)
            self._build(state, self._thickness + min(skin, _MOST_SKIN_OF_CELL * cell))
            self._common_moved = _NOWHERE
        else:
            self._common_moved = tuple(
                0.5 * (a + b) - 0.5 * length * (c + d)
                for a, b, c, d in zip(least, most, slowest, fastest))
        # Pins and what lies on a collider stay where they are, whatever ways are cut.
        is_free = not (self._scene.has_contact or state.pinned.any())
        self._common_way = tuple(
            0.5 * length * (c + d) for c, d in zip(slowest, fastest)) if is_free else _NOWHERE
        speed = way / length + self._gravity * length + _LEAST_SPEED
        self._serves_again = self._window > 0 and self._may_serve_again(way, speed)
        if self._serves_again:
            self._window -= 1
        elif self.has_pairs:
            self._set_impulse_unit(speed)
            self._set_window(way)
            self._find_contacts(state)
        else:
            self._clear_contacts()
        if not self.has_pairs and way > 0.0:
            left = 0.5 * _USED * (self._reach - self._thickness) - min(moved, room)
            self._unlooked = int(min(_MOST_UNLOOKED, left / (_FASTER * way)))

    def _may_serve_again(self, way: float, speed: float) -> bool:
        """Return whether the contacts of an earlier substep are valid for the current one."""
        return (
            self._gone + way <= self._most_gone
            and speed <= self._impulse_unit * (2.0**31 / _SUM_RANGE))

    def _set_window(self, way: float) -> None:
        """Choose for how many substeps the contacts found now are valid."""
        window = 1
        if not self._is_implicit:
            window = int(min(_MOST_WINDOW, max(1.0, self._most_gone / max(way, 1e-30))))
        self._window, self._gone = window - 1, 0.0

    def _set_impulse_unit(self, speed: float) -> None:
        """Choose the smallest power of two for which sums of impulses do not overflow."""
        if not math.isfinite(speed):
            # What checks the state finds that.
            speed = _LEAST_SPEED
        unit = 2.0**math.ceil(math.log2(speed * _SUM_RANGE / 2.0**31))
        self._impulse_unit = unit
        self._set('impulse_unit', unit)

    def begin(self, state: SubstepEnds) -> None:
        """Begin with the impulses of the last substep."""
        self.go_on(state)
        self._is_first = True
        if self._acts_on_surface and not self._serves_again:
            self._head.bind_dispatches()
            shader_dispatches_visible()
            self._add_up()

    def go_on(self, state: SubstepEnds) -> None:
        """Continue after other passes have bound their buffers."""
        state.bind_in_textures()
        state.bind_out_textures()
        state.bind_out()
        if self._is_implicit:
            self._bind()

    def let_act(self) -> None:
        """Iterate the impulses in rounds, with colliders on the nodes that they hold."""
        self._head.bind_dispatches()
        shader_dispatches_visible()
        rounds, (some, most) = 0, self._rounds
        while True:
            is_again = self._is_first and self._serves_again
            self._add_up(is_summed=is_again)
            self._wake(_AGAIN if is_again else _ASLEEP)
            self._make_rounds(some)
            rounds += some
            head = self._read_head()
            _refuse_too_many(head)
            if rounds >= most or (
                    head['largest_change'] <= _STILL * head['largest_impulse']):
                break
            self._head.write(np.zeros(2, dtype=np.uint32), _place('largest_impulse'))
        if self._is_implicit or self._acts_on_surface:
            self._add_up()

    def _add_up(self, *, is_summed: bool = False) -> None:
        """
        Add up the impulses on each node, and find its velocity by them.

        :param is_summed: whether they have not changed since they were added up
        """
        sums = self._use('sums')
        sums.set_int('is_summed', int(is_summed))
        sums.dispatch_indirect(_NODE_GROUPS)
        shader_writes_visible()

    def _wake(self, looks: int) -> None:
        """List contacts that act, among those that ``looks`` names."""
        self._use(f'wake {looks}').dispatch_indirect(_CONTACT_GROUPS)
        shader_dispatches_visible()

    def give(self, held_at: int, *, notes_changes: bool = False) -> None:
        """
        Write the next state of the nodes in contact.

        :param held_at: first entry of the substep in held.glsl; below 0: none
        :param notes_changes: whether changes of velocity are noted for the limits of edges, which
            are bound
        """
        self._head.bind_dispatches()
        program = self._use(_last_pass(held_at, notes_changes))
        if held_at >= 0:
            program.set_int('held_at', held_at)
        program.dispatch_indirect(_NODE_GROUPS)
        shader_writes_visible()

    def guard(self, state: SubstepEnds) -> SelfContactFigures:
        """Shorten displacements so that nothing passes; wait, and return the result."""
        state.bind_in_textures()
        state.bind_out_textures()
        self._run_over_nodes('longest')
        head = self._read_head()
        # NaN is no reason to go on: what checks the state finds it.
        longest = float(head['longest_way'])
        # Pairs that were looked at when contacts were found; others were farther than those act.
        nearest = min(
            float(head['least_distance']),
            _edge_thickness(is_implicit=self._is_implicit) * self._thickness) - 2.0 * self._gone
        self._gone += longest
        rounding = _ROUNDING * float(head['largest']) + 1e-9
        if head['cut_nodes'] or (1.0 - _LEFT) * nearest <= 2.0 * (longest + rounding):
            self._cut(state, rounding)
            head = self._read_head()
        least = float(head['least_distance'])
        if least < _DOUBTFUL * self._thickness:
            # As near as that rounding may have decided: counted with the next lists, made at once.
            self._has_doubts, self._reach = True, 0.0
        return SelfContactFigures(
            int(head['contact_count']), least, int(head['cut_nodes']),
            float(head['largest_cut']), int(head['undivided']), int(head['cut_pins']))

    def _cut(self, state: SubstepEnds, rounding: float) -> None:
        """Shorten the ways of nodes; ``rounding`` of a displacement [m]."""
        for guard in self._each_kind_of('guard'):
            guard.set_float('rounding', 2.0 * rounding)
            guard.set_vectors('common_way', self._common_way)
        self._head.write(np.zeros(1, dtype=np.uint32), _place('cut_nodes'))
        state.bind_out()
        self._run_over_nodes('cut')

    def delete(self) -> None:
        """Release everything."""
        for program in self._programs.values():
            program.delete()
        for buffer in (
                self._head, self._features, self._built, self._velocities, self._cell_ways,
                self._boxes, self._first, *self._pairs, self._kept, self._nodes,
                self._contacts, self._acting, self._entries, self._applied, self._driven):
            buffer.delete()

    def _use(self, name: str) -> Program:
        """Return a pass, in use, with the uniforms that it has in common with others."""
        program = self._programs[name].use()
        if self._set_for.get(name) != self._version:
            self._set_for[name] = self._version
            for uniform, value in self._uniforms.items():
                program.set_float(uniform, value)
            program.set_int('most_pairs', self._most_pairs)
            if name in ('boxes', 'crossings', 'pairs'):
                program.set_int('level_count', len(self._levels))
                program.set_int_vectors('levels', self._levels)
        if name.startswith('nodes') and self._set_colliders_in is not None:
            self._set_colliders_in(program)
        return program

    def _set(self, uniform: str, value: float) -> None:
        """Set a uniform in all passes, each at its next use."""
        if self._uniforms.get(uniform) != value:
            self._uniforms[uniform] = value
            self._version += 1

    def _run_over_nodes(self, name: str) -> None:
        program = self._use(name)
        program.set_float('room', 0.5 * _ROOM * self._reach)
        program.set_vectors('common_way', self._common_way)
        program.set_vectors('common_moved', self._common_moved)
        program.dispatch(*self._strips)
        shader_writes_visible()

    def _make_rounds(self, count: int) -> None:
        """Make rounds of impulses, the nodes with their velocities before each."""
        nodes, impulses = self._use('nodes'), self._use('round')
        is_first, self._is_first = self._is_first, False
        if is_first not in self._rounds_made:
            self._rounds_made[is_first] = [
                call for number in range(count) for call in (
                    *nodes.indirect_calls(_NODE_GROUPS, is_summed=int(number == 0)),
                    writes_visible_call(),
                    *impulses.indirect_calls(_ACTING_GROUPS, part=(
                        _FIRST_ROUND * (is_first and number == 0)
                        + _LAST_ROUND * (number == count - 1))),
                    writes_visible_call())]
        make(self._rounds_made[is_first])
        nodes.submitted(count)
        impulses.submitted(count)

    def _find_contacts(self, state: SubstepEnds) -> None:
        self._clear_contacts()
        state.bind_in_textures()
        state.bind_out_textures()
        self._has_found = True
        for program in self._each_kind_of('contacts'):
            program.set_float('kept_share', self._share_to_keep)
            program.set_float('window', float(self._window + 1))
        self._use('list').dispatch(*self._strips)
        self._head.bind_dispatches()
        shader_dispatches_visible()
        self._wake(_FOUND)

    def _clear_contacts(self) -> None:
        """Forget the contacts that were found, if there are some."""
        if not self._has_found:
            return
        self._has_found = False
        self._head.bind_dispatches()
        shader_dispatches_visible()
        self._use('clear').dispatch_indirect(_NODE_GROUPS)
        self._head.write(self._fresh_contacts)

    def _each_kind_of(self, name: str) -> Iterator[Program]:
        """Yield the pass over each kind of pairs to be set, and run it."""
        for of_edges, count in enumerate(self._counts):
            if count:
                program = self._use(f'{name} {of_edges}')
                yield program
                each = self._pairs_each if name == 'contacts' else 1
                _dispatch_pairs(program, -(-count // each))
        shader_writes_visible()

    def _build(self, state: SubstepEnds, reach: float) -> None:
        """List the pairs within ``reach`` [m]; room grows until it suffices."""
        self._reach = reach
        self._window = 0
        boxes = self._use('boxes')
        state.bind_in_textures()
        for level, (rows, cols, *_) in enumerate(self._levels):
            boxes.set_int('level', level)
            boxes.dispatch(-(-int(rows * cols) // _LOCAL))
            shader_writes_visible()
        if self._crossings or self._has_doubts:
            self._count_crossings()
        # None of a state that was set, whose impulses belong to another one.
        keeps = self._has_found and self.has_pairs
        self._pairs.reverse()
        if self._pairs[0].bytes < self._most_pairs * _PAIR_BYTES:
            self._make_room(self._most_pairs)
        while True:
            self._head.write(np.zeros(2, dtype=np.uint32), _place('vertex_pairs'))
            self._bind()
            self._kept.clear()
            pairs = self._use('pairs')
            pairs.set_float('reach', reach)
            pairs.dispatch(-(-self._scene.node_count // _LOCAL))
            shader_writes_visible()
            head = self._read_head()
            self._counts = int(head['vertex_pairs']), int(head['edge_pairs'])
            _refuse_unfinished(head)
            if sum(self._counts) <= self._most_pairs:
                break
            self._make_room(2 * sum(self._counts))
        if keeps and self.has_pairs:
            self._copy_kept()
        if self._contacts.bytes < self._most_pairs * _CONTACT_BYTES:
            self._make_room_for_contacts()

    def _copy_kept(self) -> None:
        """Copy the impulses of the contacts that act to their pairs."""
        self._head.bind_dispatches()
        self._use('keep').dispatch_indirect(_ACTING_GROUPS)
        shader_writes_visible()

    def _count_crossings(self) -> None:
        self._use('crossings').dispatch(-(-self._scene.node_count // _LOCAL))
        shader_writes_visible()
        head = self._read_head()
        _refuse_unfinished(head)
        self._crossings, self._has_doubts = int(head['crossing_edges']), False
        is_new, self._is_new = self._is_new, False
        if is_new and self._crossings:
            row, col = divmod(int(head['first_crossing']), self._layout.pitch)
            warnings.warn(
                f'the cloth begins with {self._crossings} edges that pass through it, the first '
                f'at node ({row - HALO}, {col - HALO}), and stays so there: begin with layers '
                f'{self._thickness:g} m apart', stacklevel=4)

    def _make_room(self, pairs: int) -> None:
        self._most_pairs = pairs
        self._version += 1
        # The list before is still to be read; it grows when it is written next.
        self._pairs[0].delete()
        self._kept.delete()
        self._pairs[0] = Buffer(pairs * _PAIR_BYTES)
        self._kept = Buffer(pairs * _PAIR_BYTES)
        self._binds.clear()
        self._rows.clear()

    def _make_room_for_contacts(self) -> None:
        """Have room for a contact of each pair; those there are forgotten."""
        self._clear_contacts()
        self._contacts.delete()
        self._acting.delete()
        self._entries.delete()
        self._contacts = Buffer(self._most_pairs * _CONTACT_BYTES)
        self._acting = Buffer(self._most_pairs * _ACTING_BYTES)
        self._entries = Buffer(self._entry_bytes())
        self._binds.clear()
        self._rows.clear()
        self._bind()

    def _entry_bytes(self) -> int:
        """Return the room for the entries of all nodes, whose number is even at each."""
        return (4 * self._most_pairs + self._scene.node_count) * _ENTRY_BYTES

    def _bind(self) -> None:
        pairs = self._pairs[0].name
        if pairs not in self._binds:
            self._binds[pairs] = self._bind_calls()
        make(self._binds[pairs])

    def _bind_calls(self) -> list[Call]:
        row = BufferRow((
            self._features, self._built, self._boxes, self._first, *self._pairs, self._contacts,
            self._nodes, self._velocities, self._kept, self._cell_ways, self._applied,
            self._driven, self._acting, self._entries))
        self._rows.append(row)
        return [
            self._head.storage_call(bindings.SELF_HEAD),
            *row.storage_calls(bindings.SELF_FEATURES),
            *row.texture_calls(bindings.SELF_FEATURES)]

    def _set_length(self, length: float) -> None:
        self._fresh['vertex_pairs'], self._fresh['edge_pairs'] = self._counts
        if length == self._length:
            return
        self._length = length
        self._window = 0
        self._set('substep', length)
        self._set('least_speed_unit', self._gravity * length + _LEAST_SPEED)
        self._set('way_unit', length * _WAY_RANGE)

    def _read_head(self) -> np.void:
        make(self._look)
        refuse_lost_context()
        return self._read[0]


def _edge_thickness(*, is_implicit: bool) -> float:
    return _OF_EDGES_IN_SOLVES if is_implicit else _OF_EDGES


def _programs(
        scene: Scene, layout: Layout, *, is_implicit: bool,
        may_note: bool) -> dict[str, SceneProgram]:
    """Return the passes by name; of those over pairs, one for each kind: 0 and 1, of edges."""
    strips = Strips.defines()
    of_items: dict[str, object] = {'SELF_LOCAL': _LOCAL, 'MOST_GROUPS': MOST_GROUPS}
    # Solves let thin colliders act.
    has_surface = int(bool(scene.thin_colliders) and not is_implicit)
    of_nodes: dict[str, object] = {
        **of_items, 'HAS_SURFACE': has_surface, 'IS_IMPLICIT': int(is_implicit),
        'PRESS_ON_TRIANGLES': mask_of(scene.thin_colliders if has_surface else ())}
    forms: dict[str, dict[str, object]] = {
        **dict.fromkeys(('boxes', 'clear', 'crossings', 'pairs', 'keep', 'round'), of_items),
        **{f'wake {looks}': {**of_items, 'LOOKS': looks, 'CONTACTS_EACH': _contacts_each(layout)}
           for looks in range(3)},
        # With what layers do to pinned nodes added to the entries of held.glsl, and with changes
        # of velocity noted for the limits of edges.
        **{name: {
            **of_nodes, 'IS_SUM': is_sum, 'IS_LAST': 0, 'HAS_HELD': 0, 'NOTES_CHANGES': 0}
           for is_sum, name in enumerate(('nodes', 'sums'))},
        **{_last_pass(held - 1, notes): {
            **of_nodes, 'IS_SUM': 0, 'IS_LAST': 1, 'HAS_HELD': held, 'NOTES_CHANGES': notes}
           for held in (0, 1) for notes in range(1 + may_note)},
        **{f'{name} {of_edges}': {
            **of_items, 'OF_EDGES': of_edges, 'IS_IMPLICIT': int(is_implicit),
            'EDGE_THICKNESS': _edge_thickness(is_implicit=is_implicit),
            **({'PAIRS_EACH': _pairs_each(layout), 'CONTACTS_EACH': _contacts_each(layout)}
               if name == 'contacts' else {'PAIRS_EACH': 1})}
           for name in ('contacts', 'guard') for of_edges in (0, 1)},
        'list': {**of_items, **strips},
        **dict.fromkeys(('ways', 'longest', 'cut', *(('drive',) * is_implicit)), strips)}
    files = {name: 'nodes' if name == 'sums' else name.split()[0] for name in forms}
    return {
        name: SceneProgram(
            f'self_contact/{files[name]}.comp', scene, layout, {**_READS, **defines})
        for name, defines in forms.items()}


def _last_pass(held_at: int, notes_changes: bool | int) -> str:
    """Return the name of the pass that writes the state to come; arguments as of ``give``."""
    return f'nodes last{" held" * (held_at >= 0)}{" noting" * notes_changes}'


def _pairs_each(layout: Layout) -> int:
    """Return how many pairs an invocation looks at for contacts."""
    return _PAIRS_OF_SOFTWARE if layout.texture_loads else 1


def _contacts_each(layout: Layout) -> int:
    """Return how many contacts an invocation looks at before rounds."""
    return _CONTACTS_OF_SOFTWARE if layout.texture_loads else 1


def _dispatch_pairs(program: Program, invocations: int) -> None:
    groups = -(-invocations // _LOCAL)
    program.dispatch(min(groups, MOST_GROUPS), -(-groups // MOST_GROUPS))


def _refuse_too_many(head: np.void) -> None:
    if max(head['contact_groups'][0], head['acting_groups'][0]) > MOST_GROUPS:
        raise DeviceError(
            f'{head["contact_count"]} contacts of the cloth with itself are more than the '
            f'{MOST_GROUPS * _LOCAL} of one dispatch: use fewer nodes')


def _refuse_unfinished(head: np.void) -> None:
    if head['unfinished']:
        raise DeviceError(
            f'{head["unfinished"]} nodes have more of the cloth near them than the device looks '
            'through in one pass: use fewer nodes, or smaller steps')


def _fresh_head() -> np.ndarray:
    head = np.zeros(1, dtype=_HEAD)
    head['least_moved'] = head['least_speed'] = _LEAST
    for name in ('contact_groups', 'node_groups', 'acting_groups'):
        head[name][0, 1:] = 1
    head['least_distance'] = np.inf
    head['first_crossing'] = _LEAST
    return head


def _from_order(numbers: list[int]) -> list[tuple[float, ...]]:
    """Return the four vectors of ``in_order`` in head.glsl."""
    floats = struct.unpack('12f', struct.pack('12I', *(
        number & 0x7FFFFFFF if number & 0x80000000 else number ^ 0xFFFFFFFF
        for number in numbers)))
    return [floats[first:first + 3] for first in range(0, 12, 3)]


def _levels(rows: int, cols: int) -> np.ndarray:
    """Return rows, columns and place of each level of the tree of boxes, the lowest first."""
    levels = []
    begin = 0
    while True:
        levels.append((rows, cols, begin, 0))
        begin += rows * cols
        if rows * cols == 1:
            return np.array(levels)
        rows, cols = -(-rows // 2), -(-cols // 2)


def _owned(scene: Scene) -> np.ndarray:
    """Return what each node owns, as bits of features.glsl, (rows, cols) uint32."""
    there = np.ones((scene.rows - 1, scene.cols - 1), dtype=bool)
    if scene.cut_cells is not None:
        there = scene.cut_cells
    around = np.pad(there, 1)
    here, above, left = around[1:, 1:], around[:-1, 1:], around[1:, :-1]
    corner = around[:-1, :-1]
    return (
        1 * (here | above) + 2 * (here | left) + 4 * here
        + 8 * (here | above | left | corner)).astype(np.uint32)
