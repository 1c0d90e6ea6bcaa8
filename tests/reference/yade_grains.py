"""Grains without bonds in YADE: yade -n -x yade_grains.py INPUT.npz OUTPUT.npz

Spheres of one size between plane walls, with the law of Cundall and Strack and a share of the force as
damping; a rigid tool of facets moves through them with a constant velocity. YADE's springs follow from
the sizes, k_n = 2 E r_1 r_2 / (r_1 + r_2), with r_1 = r_2 for walls and r_1 = 2 r_2 for facets: so all
contacts have the same stiffness, and those with the tool 4/3 of it."""

import sys

import numpy as np

given = dict(np.load(sys.argv[1]))
r, m = float(given["radius"]), float(given["mass"])
g, dt = Vector3(*map(float, given["gravity"])), float(given["time_step"])
O.reset()
material = O.materials.append(FrictMat(
    young=float(given["k_n"]) / r, poisson=float(given["k_t"] / given["k_n"]),
    frictionAngle=float(np.arctan(given["friction"])), density=2600.0))
grains = []
for x in given["position"]:
    grain = O.bodies[O.bodies.append(utils.sphere(tuple(map(float, x)), r, material=material))]
    grain.state.mass, grain.state.inertia = m, Vector3(1, 1, 1) * (0.4 * m * r * r)
    grains.append(grain)
for axis, sense, place in given["walls"]:
    O.bodies.append(utils.wall(float(place), int(axis), sense=int(sense), material=material))
tool = []
for corners in given["facets"]:
    facet = utils.facet([tuple(map(float, x)) for x in corners], material=material)
    tool.append(O.bodies.append(facet))
    facet.state.blockedDOFs = "xyzXYZ"

energy, height, force = [], [], []
every = int(given["every"])


def observe():
    if O.iter == 0:  # the first half of a step of weight, so that the velocities are those of kerf
        for grain in grains:
            grain.state.vel = -0.5 * dt * g
        for k in tool:
            O.bodies[k].state.vel = Vector3(*map(float, given["tool_velocity"]))
    if O.iter % every == 0:
        energy.append(sum(0.5 * m * s.state.vel.squaredNorm() + 0.2 * m * r * r *
                          s.state.angVel.squaredNorm() for s in grains))
        height.append([s.state.pos[2] for s in grains])
        force.append(sum((O.forces.f(k) for k in tool), Vector3.Zero))


O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()], verletDist=0.2 * r),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False),
                     Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
                    [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
    PyRunner(command="observe()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=float(given["damping"]), gravity=g),
]
O.dt = dt
O.run(int(given["steps"]), True)
np.savez(sys.argv[2], energy=energy, height=height, force=np.array([tuple(f) for f in force]))
