# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every shader, in every form a scene can ask for, is portable GLSL."""

from collections import Counter
from itertools import product
from math import prod
from pathlib import Path
import re
import subprocess

from cloth_sim_ros.gl.shader_source import ShaderSource
from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import scene_defines
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.solver_buffers import Levels
from cloth_sim_ros.sim.solver.solver_buffers import MOST_TOGETHER
from cloth_sim_ros.sim.solver.solver_programs import solver_defines
from cloth_sim_ros.sim.solver.solver_programs import TOGETHER_LOCAL
from cloth_sim_ros.study.timed_solvers import paper_solver_defines
import pytest
from springs import SPRINGS

# A macro with the lines that it goes on in.
_DEFINE = re.compile(r'^#define\s+(\w+)(?:[^\n]*\\\n)*[^\n]*\n', re.MULTILINE)
_SCENES = {
    'all': {},
    'no_bend': {'stiffness.bend': 0.0, 'damping.bend': 0.0},
    'rigid': {'bending.rigidity': 1e-4, 'stiffness.bend': 0.0, 'damping.bend': 0.0},
    'rigid_damped': {
        'bending.rigidity': 1e-4, 'bending.damping': 0.01, 'stiffness.shear': 0.0,
        'damping.shear': 0.0},
    'structural_undamped': {
        'stiffness.shear': 0.0, 'stiffness.bend': 0.0, 'damping.structural': 0.0,
        'damping.shear': 0.0, 'damping.bend': 0.0},
    'touching_a_plane': {'colliders.names': ['a'], 'colliders.a.shape': 'plane'},
    'touching_two': {
        'colliders.names': ['a', 'b'], 'colliders.a.shape': 'plane', 'colliders.b.size': [1.0]},
    'touching_four': {
        'colliders.names': ['a', 'b', 'c', 'd'], 'colliders.a.shape': 'plane',
        'colliders.b.size': [1.0], 'colliders.c.size': [1.0], 'colliders.d.size': [1.0]},
    'touching_all': {
        'colliders.names': ['a', 'b', 'c', 'd', 'e'], 'colliders.a.shape': 'plane',
        'colliders.b.size': [1.0],
        'colliders.c.shape': 'box', 'colliders.c.size': [1.0, 1.0, 1.0],
        'colliders.d.shape': 'cylinder', 'colliders.d.size': [1.0, 1.0],
        'colliders.e.shape': 'capsule', 'colliders.e.size': [1.0, 1.0]},
}
# Those that no other scene asks for.
_OF_CONTACT = (
    'contact.comp', 'foresee_contact.comp', 'near_blocks.comp', 'near_nodes.comp',
    'surface_contact.comp', 'surface_pins.comp',
    'solver/contact.comp', 'solver/surface_find.comp', 'solver/surface_give.comp',
    'solver/surface_list.comp', 'solver/surface_product.comp', 'solver/surface_record.comp',
    'solver/surface_search.comp', 'solver/surface_weigh.comp',
    'solver/hold.comp', 'solver/near.comp', 'solver/reaction.comp')
# Where integers are counted by atomics, and no result depends on the order.
_COUNTING = {
    # The paper's solver, which only a benchmark runs, counts entries as the paper does.
    'paper/solver/spmm.comp': ['atomicAdd(row_count[i], 1u)'],
    # One flag, which any edge raises.
    'solver/right_side.comp': ['atomicOr(is_off, floatBitsToUint(1.0))'],
    # Tells the last workgroup, which does what any other would do in its place.
    'solver/product.comp': ['atomicAdd(finished_groups, 1u)'],
    # Lists of blocks and of their nodes, each of which is treated by itself.
    'include/block_bound.glsl': [
        'atomicAdd(near_block_count, 1u)',
        'atomicAdd(block_groups_x, place % BLOCKS_AT_ONCE == 0u ? 1u : 0u)'],
    # Counts the marked blocks, each of which is listed by itself; one is compared with 0.
    'limit/look.comp': [
        'atomicExchange(lists[block], 1u)', 'atomicAdd(marked_count, 1u)',
        'atomicAdd(list_groups_x, place % LIST_LOCAL == 0u ? 1u : 0u)'],
    'include/limit_list.glsl': ['atomicAdd(newly_listed, added)'],
    # Lists that are walked, or places in them that are kept: no sum goes by their order.
    'surface_contact.comp': [
        'atomicAdd(surface_missed, 1u)', 'atomicAdd(surface_lost, 1u)',
        'atomicAdd(surface_entries, count)', 'atomicAdd(acting_rows, 1u)',
        'atomicAdd(held_nodes, 1u)', 'atomicAdd(listed_rows, uint(count))',
        'atomicAdd(listed_rows, 1u)',
        'atomicOr(surface_rows[entry.first_row].spare.y, 1u << uint(row))',
        'atomicMax(largest, floatBitsToUint(length(impulse)))',
        'atomicMax(largest_pressed, floatBitsToUint(facing.w))',
        'atomicMax(largest_change, floatBitsToUint(length(impulse - before)))'],
    # Only whether there are any counts.
    'solver/surface_find.comp': ['atomicAdd(changed_owners, 1u)', 'atomicAdd(owners, 1u)'],
    # Sums of whole numbers, least and largest numbers, counts, and lists in no order.
    'self_contact/ways.comp': [
        'atomicMax(largest, floatBitsToUint(max(most_place.x, max(most_place.y, most_place.z))))',
        'atomicMin(least_moved[k], in_order(least[k]))',
        'atomicMax(most_moved[k], in_order(most[k]))',
        'atomicMin(least_speed[k], in_order(slowest[k]))',
        'atomicMax(most_speed[k], in_order(fastest[k]))'],
    'self_contact/crossings.comp': [
        'atomicAdd(crossing_edges, 1u)', 'atomicMin(first_crossing, uint(one.index))',
        'atomicAdd(unfinished, 1u)'],
    'self_contact/pairs.comp': [
        'atomicAdd(edge_pairs, 1u)', 'atomicAdd(vertex_pairs, 1u)', 'atomicAdd(unfinished, 1u)'],
    'include/self_contact/contacts.glsl': [
        'atomicAdd(acting_count, 1u)',
        'atomicAdd(acting_groups[0], at % SELF_LOCAL == 0u ? 1u : 0u)',
        'atomicAdd(self_nodes[nodes[k]].shares, share)',
        'atomicAdd(self_nodes[nodes[k]].entries, 1u)'],
    'self_contact/list.comp': [
        'atomicAdd(self_node_count, 1u)',
        'atomicAdd(node_groups[0], place % SELF_LOCAL == 0u ? 1u : 0u)',
        'atomicAdd(entry_count, (contacts + 1u) / 2u)'],
    'self_contact/wake.comp': [
        'atomicMin(least_distance, floatBitsToUint(nearest))'],
    'self_contact/contacts.comp': [
        'atomicAdd(contact_count, 1u)',
        'atomicAdd(contact_groups[0], at % (SELF_LOCAL * CONTACTS_EACH) == 0u ? 1u : 0u)',
        'atomicAdd(self_nodes[nodes[i]].contacts, 1u)',
        'atomicMin(least_distance, floatBitsToUint(nearest))'],
    'self_contact/round.comp': [
        'atomicAdd(self_nodes[node].way[k], change[k])',
        'atomicMax(largest_impulse, floatBitsToUint(length(impulse)))',
        'atomicMax(largest_change, floatBitsToUint(share * length(impulse - own.xyz)))'],
    'self_contact/longest.comp': [
        'atomicMax(longest_way, floatBitsToUint(longest))', 'atomicAdd(cut_nodes, 1u)'],
    'self_contact/guard.comp': [
        'atomicAdd(undivided, 1u)',
        'atomicMin(self_nodes[nodes[k]].cut, floatBitsToUint(max(-past, 0.0) / towards))'],
    'self_contact/cut.comp': [
        'atomicMax(longest_way, floatBitsToUint(longest))',
        'atomicMax(largest_cut, floatBitsToUint(most_cut))', 'atomicAdd(cut_nodes, cuts)',
        'atomicAdd(cut_pins, pins)'],
    'self_contact/drive.comp': ['atomicMax(largest_drive, floatBitsToUint(largest))'],
    'solver/near.comp': [
        'atomicAdd(near_count, 1u)',
        'atomicAdd(near_groups_x, place % NEAR_LOCAL == 0u ? 1u : 0u)'],
    'near_nodes.comp': [
        'atomicAdd(near_node_count, 1u)',
        'atomicAdd(node_groups_x, entry % NEAR_LOCAL == 0u ? 1u : 0u)'],
}
_SURFACE = {
    'SURFACE_TIPS': 8, 'SURFACE_LOCAL': 64, 'SURFACE_COLLIDERS': '2u', 'THIN_COLLIDERS': 1,
    'SURFACE_STORED': 400}
# What each shader is compiled with besides; a comma sets further forms of one apart.
_FORMS = {
    'bounds_check.comp': {'STRIP': 16},
    'mass_spring_step.comp': {},
    'mass_spring_step.comp, recording': {'HAS_HELD': 1},
    'mass_spring_step.comp, own bodies': {'OWN_BODIES': 1},
    'paper/spring_velocity.comp': {},
    'paper/spring_velocity.comp, recording': {'HAS_HELD': 1},
    'mass_spring_tile.comp': {'TILE_SIDE': 32},
    'contact.comp': {'NOTES_CHANGES': 0},
    'contact.comp, after limits': {'NOTES_CHANGES': 1},
    'contact.comp, own bodies': {'NOTES_CHANGES': 0, 'OWN_BODIES': 1},
    'near_nodes.comp, own bodies': {'OWN_BODIES': 1},
    'near_nodes.comp, of the surface': {'HAS_SURFACE': 1, **_SURFACE},
    'contact.comp, beside the surface': {'NOTES_CHANGES': 0, 'HAS_SURFACE': 1},
    'surface_contact.comp': {
        'WAYS_OUT': 0, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 1, **_SURFACE},
    'surface_contact.comp, after limits': {
        'WAYS_OUT': 0, 'NOTES_CHANGES': 1, 'FINDS_IMPULSES': 1, **_SURFACE},
    'surface_contact.comp, ways out': {
        'WAYS_OUT': 1, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 1, **_SURFACE, 'SURFACE_TIPS': 2},
    'surface_contact.comp, of nodes': {
        'WAYS_OUT': 0, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 0, **_SURFACE},
    'surface_contact.comp, beside layers': {
        'WAYS_OUT': 0, 'NOTES_CHANGES': 0, 'FINDS_IMPULSES': 1, 'HAS_SELF': 1, **_SURFACE},
    'self_contact/nodes.comp, beside the surface': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_SUM': 0, 'IS_LAST': 1, 'HAS_HELD': 1,
        'HAS_SELF': 1, 'HAS_SURFACE': 1},
    'contact.comp, beside layers': {'NOTES_CHANGES': 0, 'HAS_SELF': 1},
    **{f'self_contact/{name}.comp': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'MOST_GROUPS': 65535}
       for name in (
           'boxes', 'clear', 'crossings', 'keep', 'nodes', 'pairs', 'round')},
    **{f'self_contact/wake.comp{words}': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'CONTACTS_EACH': 16, 'LOOKS': looks}
       for looks, words in enumerate(('', ', asleep', ', again'))},
    'self_contact/nodes.comp, sums': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_SUM': 1, 'HAS_SELF': 1, 'HAS_SURFACE': 1},
    'self_contact/nodes.comp, sums of solves': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_SUM': 1, 'IS_IMPLICIT': 1},
    'self_contact/contacts.comp, of solves': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'OF_EDGES': 1, 'MOST_GROUPS': 65535,
        'IS_IMPLICIT': 1, 'PAIRS_EACH': 1, 'CONTACTS_EACH': 1, 'EDGE_THICKNESS': 0.9999},
    'self_contact/nodes.comp, last': {'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_LAST': 1},
    'self_contact/nodes.comp, after limits': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_LAST': 1, 'HAS_HELD': 1, 'NOTES_CHANGES': 1},
    'self_contact/nodes.comp, of solves': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_LAST': 1, 'HAS_HELD': 1, 'IS_IMPLICIT': 1},
    'self_contact/nodes.comp, recording': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'IS_LAST': 1, 'HAS_HELD': 1, 'HAS_LOW_PARTS': 1},
    **{f'self_contact/{name}.comp{words}': {
        'LOADS_TEXTURE': 1, 'SELF_LOCAL': 32, 'OF_EDGES': of_edges, 'MOST_GROUPS': 65535,
        'PAIRS_EACH': each, 'CONTACTS_EACH': 16, 'EDGE_THICKNESS': 0.999}
       for name, each in (('contacts', 16), ('guard', 1))
       for words, of_edges in (('', 0), (', of edges', 1))},
    **{f'self_contact/{name}.comp': {'LOADS_TEXTURE': 1, 'STRIP': 16} for name in (
        'cut', 'drive', 'longest', 'ways')},
    'self_contact/list.comp': {'SELF_LOCAL': 32, 'STRIP': 16},
    'limit/look.comp': {'STRIP': 16, 'LIST_LOCAL': '8u'},
    'limit/list.comp': {'LIST_LOCAL': 8},
    'limit/solve.comp': {'LOCAL': 256, 'LISTS': 0},
    'limit/solve.comp, listing': {'LOCAL': 8, 'LISTS': 1},
    'observe.comp': {'RECORDS_WANTED': 1, 'STRIP': 16},
    'place_pins.comp': {'PINS_LOCAL': 32},
    'paper/force.comp': {},
    'paper/update.comp': {'UPDATE_LOCAL': 1024},
    'paper/finish.comp, recording': {'HAS_HELD': 1},
    'paper/update.comp, recording': {'UPDATE_LOCAL': 1024, 'HAS_HELD': 1},
    'fold_held.comp': {'FOLD_LOCAL': 32},
    **{f'paper/solver/{name}.comp': paper_solver_defines(150, 63) for name in (
        'constraint', 'direction', 'dot', 'scalars', 'spmm', 'spmv', 'update')},
    'rigid_sums.comp': {'STRIP': 16},
    'solver/coarsest.comp': {'COARSEST_SIDE': 8, 'COARSEST_STEPS': 6},
    'solver/coarse_levels.comp': {
        'COARSEST_SIDE': 8, 'COARSEST_STEPS': 6, 'TOGETHER_LOCAL': TOGETHER_LOCAL,
        'MOST_TOGETHER': MOST_TOGETHER},
    'solver/coarse_systems.comp': {'TOGETHER_LOCAL': TOGETHER_LOCAL, 'LOADS_TEXTURE': 0},
    'solver/contact.comp': {'STAGE': 'BEGIN'},
    'solver/contact.comp, again': {'STAGE': 'AGAIN'},
    'solver/contact.comp, end': {'STAGE': 'END'},
    'solver/near.comp': {'STAGE': 'BEGIN'},
    'solver/near.comp, after a solve': {'STAGE': 'AFTER'},
    'surface_pins.comp': _SURFACE,
    'solver/surface_find.comp': {'STAGE': 'BEGIN', **_SURFACE},
    'solver/surface_find.comp, again': {'STAGE': 'AGAIN', **_SURFACE},
    **{f'solver/surface_{name}.comp': _SURFACE for name in (
        'give', 'list', 'product', 'record', 'search', 'weigh')},
    'solver/contact.comp, beside the surface': {'STAGE': 'AGAIN', 'NODE_COLLIDERS': '1u'},
    'solver/limit_search.comp': {'FORESEES_TURN': 1},
    'solver/limit_search.comp, turn not foreseen': {'FORESEES_TURN': 0},
    'solver/product.comp, with the reduction': {
        'REDUCES': 1, 'MOST_GROUPS_COUNTS': 48, 'LOADS_TEXTURE': 0, 'SUMS_BY_GROUP': 1},
    'solver/reduce.comp': {'MOST_GROUPS_COUNTS': 48},
    'solver/right_side.comp': {'FORESEES_TURN': 1},
    'solver/right_side.comp, turn not foreseen': {'FORESEES_TURN': 0},
    'solver/right_side.comp, with layers': {'FORESEES_TURN': 1, 'HAS_LAYERS': 1},
    'strain_watch.comp': {'STRIP': 16},
    'turn_watch.comp': {'STRIP': 16},
}


def shader_names() -> list[str]:
    """Return the shaders that are dispatched."""
    root = shader_directory()
    return sorted(str(path.relative_to(root)) for path in root.rglob('*.comp'))


def variants(form: str) -> dict[str, str]:
    """Return the texts of a form that differ in what they define and use, by their first user."""
    name = form.partition(',')[0]
    is_solver = name.startswith('solver/')
    found: dict[str, str] = {}
    for scene, texture, multigrid, block in product(
            _SCENES, (True, False), (True, False) if is_solver else (True,), (1, 4)):
        layout = Layout(7, 9, 'fused', texture, block, (8, 4))
        model = Scene({**SPRINGS, **_SCENES[scene]})
        if name in _OF_CONTACT and not model.has_contact:
            continue
        defines = {**layout.defines(), **scene_defines(model), **_FORMS.get(form, {})}
        if is_solver:
            families = [family for family in FAMILIES if model.models(family)]
            levels = Levels(
                layout, coarsen=True, has_bend='bend' in families,
                has_rigidity=model.has_rigidity, has_bending_damping=model.has_bending_damping,
                has_contact=model.has_contact, has_surface='surface' in form)
            defines.update(solver_defines(
                layout, levels, families, is_multigrid=multigrid,
                has_rigidity=model.has_rigidity,
                has_bending_damping=model.has_bending_damping,
                has_contact=model.has_contact, has_cells=model.cells is not None,
                has_surface='surface' in form))
        text = without_idle_defines(ShaderSource(name, defines).text)
        found.setdefault(text, f'{scene}, texture {texture}, multigrid {multigrid}, {block}')
    return found


def without_idle_defines(text: str) -> str:
    """Return ``text`` without the macros that nothing in it asks for: they change nothing."""
    while True:
        words = Counter(re.findall(r'\w+', text))
        kept = _DEFINE.sub(lambda define: define[0] if words[define[1]] > 1 else '', text)
        if kept == text:
            return text
        text = kept


@pytest.mark.parametrize('form', sorted({*shader_names(), *_FORMS}))
def test_glslang_accepts_the_shader(tmp_path: Path, form: str):
    """The shader would compile on one driver's leniency only."""
    found = variants(form)
    paths = [tmp_path / f'{number}.comp' for number in range(len(found))]
    for path, text in zip(paths, found):
        path.write_text(text)
    # Each is compiled by itself; one process for all saves the starts.
    done = subprocess.run(
        ['glslangValidator', '-S', 'comp', *map(str, paths)], capture_output=True, text=True)
    assert done.returncode == 0, f'{list(enumerate(found.values()))}: {done.stdout}'
    # It names them where there are several.
    assert len(paths) == 1 or done.stdout.split() == [str(path) for path in paths]


def test_an_idle_define_changes_nothing():
    """A variant would be left out that compiles to something else."""
    text = '#define ONE 1\n#define TWO ONE\n#define CALL(x) \\\n    x\nint a = {};\n'
    assert without_idle_defines(text.format('3')) == 'int a = 3;\n'
    assert without_idle_defines(text.format('TWO')) == (
        '#define ONE 1\n#define TWO ONE\nint a = TWO;\n')


def test_no_vendor_extension_and_no_float_atomics():
    """Other GPUs could not run it, or two runs would differ."""
    offenders = []
    for path in sorted(shader_directory().rglob('*.*')):
        text = path.read_text()
        for counting in _COUNTING.get(str(path.relative_to(shader_directory())), []):
            text = text.replace(counting, '')
        offenders += [
            f'{path.name}: {found}' for found in re.findall(
                r'#extension|_NV\b|_AMD\b|_INTEL\b|\batomic\w+\(', text)]
    assert offenders == []


def test_version_is_430_core():
    """A device with OpenGL 4.3 could not run it."""
    assert [
        name for name in shader_names()
        if '#version 430 core' not in (shader_directory() / name).read_text().splitlines()
        or not ShaderSource(name).text.startswith('#version 430 core\n')] == []


# What OpenGL 4.3 grants to every compute shader.
MOST_STORAGE_BLOCKS = 8
MOST_SHARED_BYTES = 32 * 1024
MOST_INVOCATIONS = 1024
_BYTES_OF = {'float': 4, 'uint': 4, 'int': 4, 'vec3': 16, 'uvec3': 16, 'vec4': 16}


def preprocessed(text: str) -> str:
    """Return ``text`` after the preprocessor, without what other choices leave out."""
    done = subprocess.run(
        ['glslangValidator', '--stdin', '-E', '-S', 'comp'], input=text, capture_output=True,
        text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize('form', sorted({*shader_names(), *_FORMS}))
def test_limits_of_opengl_43_are_kept(form: str):
    """A shader would run on the device of its author alone."""
    text, first_user = max(variants(form).items(), key=lambda entry: len(entry[0]))
    code = preprocessed(text)
    blocks = re.findall(r'layout\s*\([^)]*std430[^)]*\)[\w\s]*buffer\s+\w+\s*\{([^}]*)\}', code)
    assert len(blocks) <= MOST_STORAGE_BLOCKS, first_user
    # std430 gives a vec3 in an array the room of a vec4; the host packs 12 bytes.
    assert not any(re.search(r'\bvec3\s+\w+\s*\[', block) for block in blocks), first_user
    sizes = [int(size) for size in re.findall(r'local_size_[xyz]\s*=\s*(\d+)', code)]
    assert 1 <= prod(sizes) <= MOST_INVOCATIONS, first_user
    shared = sum(
        _BYTES_OF[kind] * eval(size.replace('/', '//'))
        for kind, size in re.findall(r'\bshared\s+(\w+)\s+\w+\s*\[([^\]]+)\]', code))
    assert shared <= MOST_SHARED_BYTES, first_user


@pytest.mark.parametrize('name', shader_names())
def test_no_index_of_an_edge_leaves_its_vector(name: str):
    """Such a constant is refused by NVIDIA's compiler, even in a branch that is never taken."""
    text = ShaderSource(name, {}).text
    assert not re.search(r'\[\s*edge\b', text)
