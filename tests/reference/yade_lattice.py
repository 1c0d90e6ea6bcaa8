"""A bonded lattice of discs in YADE: yade -n -x yade_lattice.py INPUT.npz OUTPUT.npz

Each disc is a sphere that stays in the plane, with the mass and inertia of a disc. Bonds are those of
the jointed cohesive law (JCFpm) with the stiffness of the case in every one of them, and far too
strong to break. The driven discs follow the velocities of the input."""

import sys

import numpy as np

given = dict(np.load(sys.argv[1]))
O.reset()
material = O.materials.append(JCFpmMat(young=1e9, poisson=0.3, frictionAngle=0.0, density=2600.0,
                                       type=1, tensileStrength=1e30, cohesion=1e30))
discs = []
for x, r, m in zip(given["position"], given["radius"], given["mass"]):
    disc = O.bodies[O.bodies.append(utils.sphere(tuple(float(c) for c in x), float(r), material=material))]
    disc.state.mass = float(m)
    disc.state.inertia = Vector3(1, 1, 1) * float(m * r * r / 2)
    disc.state.blockedDOFs = "zXY"
    discs.append(disc)
driven = [discs[i] for i in given["driven"]]
for disc in driven:
    disc.state.blockedDOFs = "xyzXY"


def drive():
    for disc in driven:
        disc.state.vel = Vector3(float(given["velocity"][O.iter]), 0, 0)


reach = 1.2  # neighbours are those within 1.2 of the sum of the radii; the next ones are at 1.7
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)], verletDist=0),
    InteractionLoop(
        # Arms to the contact point at its current place, as kerf has them.
        [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach, avoidGranularRatcheting=False)],
        [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
        [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()]),
    PyRunner(command="drive()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
O.dt = float(given["time_step"])
O.step()  # forms the bonds, free of stress
bonds = 0
for contact in O.interactions:
    contact.phys.kn, contact.phys.ks = float(given["k_n"]), float(given["k_t"])
    contact.phys.FnMax = contact.phys.FsMax = 1e30
    bonds += 1
O.run(int(given["steps"]) - 1, True)
assert O.iter == int(given["steps"])
np.savez(sys.argv[2], bonds=bonds,
         position=np.array([tuple(d.state.pos) for d in discs]),
         velocity=np.array([tuple(d.state.vel) for d in discs]),
         spin=np.array([d.state.angVel[2] for d in discs]))
