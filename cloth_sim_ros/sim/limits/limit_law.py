# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How hard a strain limit is, in each way of holding it."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw

# Families with a strain limit. The length of a bend spring is not a strain of the cloth.
LIMITED = ('structural', 'shear')
# Strain past its limit of an edge that carries the whole cloth, over the limit, and at most [1]: a
# grasp that tears at a taut cloth feels a finite force.
_SHARE = 0.1
_MOST = 0.002


def strain_past_limit(scene: Scene) -> float:
    """Return the strain by which an edge that carries the whole cloth passes its limit."""
    return min(_SHARE * scene['adaptive.threshold'], _MOST)


def limit_law(
        scene: Scene, limit: float, *, length: float = 0.0, transition: float = 0.0,
        geometric: float = 0.0) -> EdgeLaw:
    """
    Return the law of springs with a strain ``limit``.

    :param length: of a substep [s]
    :param transition: half the strain over which the limit comes into force, from the limit on
    :param geometric: as in edge_law
    """
    return edge_law(
        scene, length or scene['dt'], springs=scene.families, limited=LIMITED,
        limit=limit + transition, strain=strain_past_limit(scene), transition=transition,
        geometric=geometric)
