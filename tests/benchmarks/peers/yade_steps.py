"""Steps of a packing in YADE: yade -n -x -jTHREADS yade_steps.py MODEL.json STEPS

Bonded: the jointed cohesive law (JCFpm) without friction angle. Otherwise: linear springs with
tangential history and Coulomb friction. Stiffnesses and strengths are kerf's in every contact of
the start. A disc is a sphere that stays in the plane, with the mass and inertia of the disc."""

import json
import math
import sys
import time

with open(sys.argv[1]) as file:
    model = json.load(file)
steps = int(sys.argv[2])
bonded, flat = model["bonded"], model["dimension"] == 2

O.reset()
if not bonded:
    O.periodic = True
    edge = model["edge"]
    O.cell.setBox(edge, edge, 10 * max(model["radius"]) if flat else edge)
material = O.materials.append(
    JCFpmMat(young=1e9, poisson=0.3, frictionAngle=0, density=2600, type=1, tensileStrength=1e30, cohesion=1e30)
    if bonded else FrictMat(young=1e9, poisson=0.3, frictionAngle=math.atan(model["friction"]), density=2600))
for x, v, r, m, inertia in zip(*(model[key] for key in ("position", "velocity", "radius", "mass", "inertia"))):
    body = O.bodies[O.bodies.append(utils.sphere(x, r, material=material))]
    body.state.mass, body.state.inertia, body.state.vel = m, Vector3(1, 1, 1) * inertia, Vector3(v)
    if flat:
        body.state.blockedDOFs = "zXY"

# As far as kerf's bonds reach; its list reaches farther by a tenth of a mean diameter, too.
reach = 1 + model["gap_tolerance"] if bonded else 1
skin = 0.1 * sum(model["radius"]) / len(model["radius"])
geometry = Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)], verletDist=skin),
    InteractionLoop([geometry], [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
                    [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()])
    if bonded else
    InteractionLoop([geometry], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, 0)),
]
O.dt = model["time_step"]
O.step()  # makes the contacts
contacts = 0
for contact in O.interactions:
    contacts += contact.isReal
    contact.phys.kn, contact.phys.ks = model["normal_stiffness"], model["tangential_stiffness"]
    if bonded:
        contact.phys.FnMax, contact.phys.FsMax = model["tensile_strength"], model["shear_strength"]

O.run(steps // 10 + 5, True)
start = time.time()
O.run(steps, True)
# In the words of LAMMPS.
print(f"Loop time of {time.time() - start} on {O.numThreads} procs for {steps} steps with {len(O.bodies)} atoms, "
      f"{contacts / len(O.bodies):.2f} contacts a particle")
