"""A bonded block of spheres pulled apart in YADE: yade -n -x yade_block.py INPUT.npz OUTPUT.npz

Bonds are those of the jointed cohesive law (JCFpm), with the stiffness and the strengths of the case in
every one of them and no friction after they broke. The held spheres have constant velocities."""

import sys

import numpy as np

given = dict(np.load(sys.argv[1]))
O.reset()
material = O.materials.append(JCFpmMat(young=1e9, poisson=0.3, frictionAngle=0.0, density=2600.0,
                                       type=1, tensileStrength=1e30, cohesion=1e30))
spheres = []
for x, r, m in zip(given["position"], given["radius"], given["mass"]):
    sphere = O.bodies[O.bodies.append(utils.sphere(tuple(float(c) for c in x), float(r), material=material))]
    sphere.state.mass = float(m)
    sphere.state.inertia = Vector3(1, 1, 1) * float(0.4 * m * r * r)
    spheres.append(sphere)
for i, v in zip(given["held"], given["velocity"]):
    spheres[i].state.blockedDOFs = "xyzXYZ"

reach = 1.0 + float(given["gap_tolerance"])
boxes = Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)
# Arms to the contact point at its current place, as kerf has them.
geometry = Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach, avoidGranularRatcheting=False)
bonds = []


def before_moving():
    """The velocities begin after the first forces, which are those of bodies at rest."""
    bonds.append(sum(1 for contact in O.interactions if contact.phys.isCohesive))
    for i, v in zip(given["held"], given["velocity"]):
        spheres[i].state.vel = Vector3(*(float(c) for c in v))


O.engines = [
    ForceResetter(),
    InsertionSortCollider([boxes], verletDist=0.05e-3),
    InteractionLoop([geometry], [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
                    [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()]),
    PyRunner(command="before_moving()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
O.dt = float(given["time_step"])
O.step()  # forms the bonds, free of stress
boxes.aabbEnlargeFactor = geometry.interactionDetectionFactor = 1.0
for contact in O.interactions:
    contact.phys.kn, contact.phys.ks = float(given["k_n"]), float(given["k_t"])
    contact.phys.FnMax, contact.phys.FsMax = float(given["R_n"]), float(given["R_t"])
load = [0.0]
pulled = [int(i) for i, v in zip(given["held"], given["velocity"]) if v[2] > 0.0]
for step in range(1, int(given["steps"])):
    O.step()
    load.append(-sum(O.forces.f(i)[2] for i in pulled))
np.savez(sys.argv[2], bonds=np.array(bonds), load=np.array(load),
         position=np.array([tuple(s.state.pos) for s in spheres]),
         velocity=np.array([tuple(s.state.vel) for s in spheres]),
         spin=np.array([tuple(s.state.angVel) for s in spheres]))
