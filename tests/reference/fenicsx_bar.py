"""A plane strain body of quadrilaterals under central differences in FEniCSx:
python3 fenicsx_bar.py INPUT.npz OUTPUT.npz

Row-sum lumped mass, 2 x 2 Gauss points, small strain. Nodes are matched by their coordinates."""

import sys

import numpy as np
import ufl
from dolfinx import fem, la, mesh
from mpi4py import MPI
from petsc4py import PETSc
import dolfinx.fem.petsc

given = dict(np.load(sys.argv[1]))
X = given["position"]
low, high = X.min(axis=0)[:2], X.max(axis=0)[:2]
domain = mesh.create_rectangle(MPI.COMM_WORLD, [low, high], list(given["count"]),
                               mesh.CellType.quadrilateral)
V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
u, f, w = fem.Function(V), fem.Function(V), ufl.TestFunction(V)
lam, mu = float(given["lam"]), float(given["mu"])


def strain(v):
    return ufl.sym(ufl.grad(v))


dx = ufl.dx(metadata={"quadrature_degree": 2})
stress = lam * ufl.tr(strain(u)) * ufl.Identity(2) + 2 * mu * strain(u)
internal = fem.form(ufl.inner(stress, strain(w)) * dx)
one = fem.Constant(domain, PETSc.ScalarType((1.0, 1.0)))
mass = fem.assemble_vector(fem.form(float(given["density"]) * ufl.inner(one, w) * dx))
mass.scatter_reverse(la.ScatterMode.add)
m = mass.array.reshape(-1, 2)

# Row of the input for every node here.
coordinates = V.tabulate_dof_coordinates()[:, :2]
size = high - low
key = {tuple(np.round((x[:2] - low) / size * 1e7).astype(int)): i for i, x in enumerate(X)}
row = np.array([key[tuple(np.round((x - low) / size * 1e7).astype(int))] for x in coordinates])

d = given["displacement"][row, :2].copy()
v = given["velocity"][row, :2].copy()
free = 1.0 - given["fixed"][row, :2]
dt = float(given["time_step"])
for step in range(int(given["steps"])):
    u.x.array[:] = d.ravel()
    f.x.array[:] = 0
    fem.assemble_vector(f.x.array, internal)
    f.x.scatter_reverse(la.ScatterMode.add)
    a = -f.x.array.reshape(-1, 2) / m * free
    v = (v + (0.5 if step == 0 else 1.0) * dt * a) * free
    d = d + dt * v
result_d, result_v = np.zeros_like(given["displacement"]), np.zeros_like(given["velocity"])
result_d[row, :2], result_v[row, :2] = d, v
np.savez(sys.argv[2], displacement=result_d, velocity=result_v)
