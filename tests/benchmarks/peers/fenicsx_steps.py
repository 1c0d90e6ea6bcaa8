"""Explicit steps of a linear or neo-Hookean body in FEniCSx:
python3 fenicsx_steps.py FOLDER METHOD LAW STEPS WARM_UP

FOLDER has model.json, positions.bin, elements.bin and velocity.bin; displacement.bin is written to
it. METHOD assembles the internal forces anew in each step (assembled) or multiplies by a stiffness
matrix (stiffness). Row-sum lumped mass, 2 x 2 (x 2) Gauss points, central differences."""

import json
import pathlib
import sys
import time

import numpy as np
import ufl
from dolfinx import fem, la, mesh
from mpi4py import MPI
from petsc4py import PETSc
import dolfinx.fem.petsc

folder, method, law = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
steps, warm_up = int(sys.argv[4]), int(sys.argv[5])
comm = MPI.COMM_WORLD
model = json.loads((folder / "model.json").read_text())
dim, corners, nodes = model["dimension"], model["corners"], model["nodes"]
lam, mu, dt = model["lambda"], model["mu"], model["time_step"]
cell = {"tri3": "triangle", "quad4": "quadrilateral", "tet4": "tetrahedron", "hex8": "hexahedron"}[model["shape"]]
order = {"quadrilateral": [0, 1, 3, 2], "hexahedron": [0, 1, 3, 2, 4, 5, 7, 6]}.get(cell, list(range(corners)))

positions, elements = np.empty((0, dim)), np.empty((0, corners), dtype=np.int64)
if comm.rank == 0:
    positions = np.fromfile(folder / "positions.bin").reshape(-1, dim)
    elements = np.fromfile(folder / "elements.bin", dtype=np.uint32).reshape(-1, corners)[:, order].astype(np.int64)
domain = mesh.create_mesh(comm, elements, positions, ufl.Mesh(ufl.VectorElement("Lagrange", cell, 1)))
V = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
u, w = fem.Function(V), ufl.TestFunction(V)
dx = ufl.dx(metadata={"quadrature_degree": 1 if corners == dim + 1 else 2})
quick = {"cffi_extra_compile_args": ["-O3", "-march=native"]}


def linear_form(of):
    """Virtual work of the internal forces of small strain."""
    strain = ufl.sym(ufl.grad(of))
    stress = lam * ufl.tr(strain) * ufl.Identity(dim) + 2 * mu * strain
    return ufl.inner(stress, ufl.sym(ufl.grad(w))) * dx


def neo_hookean_form(of):
    F = ufl.Identity(dim) + ufl.grad(of)
    inverse = ufl.inv(F).T
    return ufl.inner(mu * (F - inverse) + lam * ufl.ln(ufl.det(F)) * inverse, ufl.grad(w)) * dx


one = fem.Constant(domain, PETSc.ScalarType((1.0,) * dim))
mass = fem.assemble_vector(fem.form(model["density"] * ufl.inner(one, w) * dx))
mass.scatter_reverse(la.ScatterMode.add)
own = V.dofmap.index_map.size_local * dim
node_of = np.empty(V.dofmap.index_map.size_local + V.dofmap.index_map.num_ghosts, dtype=np.int64)
node_of[V.dofmap.list.array] = np.array(domain.geometry.input_global_indices)[domain.geometry.dofmap.array]
node_of = node_of[:own // dim]
v = np.fromfile(folder / "velocity.bin").reshape(-1, dim)[node_of].ravel()
per_mass = dt / mass.array[:own]

if method == "assembled":
    form = fem.form((linear_form if law == "linear" else neo_hookean_form)(u), jit_params=quick)
    f = la.vector(V.dofmap.index_map, dim)
    displacement = u.x.array[:own]

    def step(share):
        global v
        f.array[:] = 0
        fem.assemble_vector(f.array, form)
        f.scatter_reverse(la.ScatterMode.add)
        force = f.array[:own]
        force *= per_mass
        if share != 1.0:
            force *= share
        v -= force
        np.multiply(v, dt, out=force)
        np.add(displacement, force, out=displacement)
        u.x.scatter_forward()
else:
    K = fem.petsc.assemble_matrix(fem.form(linear_form(ufl.TrialFunction(V)), jit_params=quick))
    K.assemble()
    K.convert("baij")
    x, f, velocity, factor = (K.createVecRight() for _ in range(4))
    velocity.array[:], factor.array[:] = v, per_mass
    displacement = x.array

    def step(share):
        K.mult(x, f)
        f.pointwiseMult(f, factor)
        velocity.axpy(-share, f)
        x.axpy(dt, velocity)

step(0.5)
for _ in range(warm_up - 1):
    step(1.0)
comm.Barrier()
start = time.perf_counter()
for _ in range(steps):
    step(1.0)
comm.Barrier()
seconds = time.perf_counter() - start
gathered = comm.gather((node_of, np.array(displacement).reshape(-1, dim)))
if comm.rank == 0:
    result = np.zeros((nodes, dim))
    for where, values in gathered:
        result[where] = values
    result.tofile(folder / "displacement.bin")
    print(f"Loop time of {seconds} s")
