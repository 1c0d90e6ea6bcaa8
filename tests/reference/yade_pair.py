"""Two spheres in YADE, bonded or with friction: yade -n -x yade_pair.py INPUT.npz OUTPUT.npz

The spheres have the positions, velocities and blocked degrees of freedom of the input, and the contact
its constants: bonds are those of the jointed cohesive law (JCFpm), friction that of Cundall and Strack.
The output has positions, velocities and forces at the middle of every step, before anything moves."""

import sys

import numpy as np

given = dict(np.load(sys.argv[1]))
bonded = bool(given["bonded"])
O.reset()
friction = float(np.arctan(given["friction"]))
material = O.materials.append(
    JCFpmMat(young=1e9, poisson=0.3, frictionAngle=friction, density=2600.0, type=1,
             tensileStrength=1e30, cohesion=1e30) if bonded else
    FrictMat(young=1e9, poisson=0.3, frictionAngle=friction, density=2600.0))
pair = []
for x, r, m, blocked in zip(given["position"], given["radius"], given["mass"], given["blocked"]):
    sphere = O.bodies[O.bodies.append(utils.sphere(tuple(map(float, x)), float(r), material=material))]
    sphere.state.mass = float(m)
    sphere.state.inertia = Vector3(1, 1, 1) * float(0.4 * m * r * r)
    sphere.state.blockedDOFs = str(blocked)
    pair.append(sphere)

steps = int(given["steps"])
position, velocity, spin = (np.zeros((steps, 2, 3)) for _ in range(3))
normal_force, shear_force, holds = np.zeros(steps), np.zeros((steps, 3)), np.zeros(steps, dtype=bool)


def observe():
    n = O.iter
    if n == 0:  # velocities begin after the first forces, which are those of bodies at rest
        for sphere, v in zip(pair, given["velocity"]):
            sphere.state.vel = Vector3(*map(float, v))
    for k, sphere in enumerate(pair):
        position[n, k], velocity[n, k] = sphere.state.pos, sphere.state.vel
        spin[n, k] = sphere.state.angVel
    if O.interactions.has(0, 1) and O.interactions[0, 1].isReal:
        contact = O.interactions[0, 1]
        if n == 0:
            phys = contact.phys
            phys.normalForce *= float(given["k_n"]) / phys.kn
            phys.kn, phys.ks = float(given["k_n"]), float(given["k_t"])
            if bonded:
                phys.FnMax, phys.FsMax = float(given["R_n"]), float(given["R_t"])
        force = contact.phys.normalForce
        normal_force[n] = -force.dot(contact.geom.normal)  # tension is positive
        shear_force[n] = contact.phys.shearForce * (-1 if contact.id1 == 0 else 1)  # on the first
        holds[n] = bonded and contact.phys.isCohesive


# Arms to the contact point at its current place, as kerf has them.
geometry = Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False)
laws = ([Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
        [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM()]) if bonded else (
            [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.05e-3),
    InteractionLoop([geometry], *laws),
    PyRunner(command="observe()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
O.dt = float(given["time_step"])
O.run(steps, True)
np.savez(sys.argv[2], position=position, velocity=velocity, spin=spin, normal_force=normal_force,
         shear_force=shear_force, holds=holds)
