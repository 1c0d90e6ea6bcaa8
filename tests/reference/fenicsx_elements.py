"""Bodies under central differences in FEniCSx: python3 fenicsx_elements.py RUNS.json OUTPUT.npz

RUNS.json is the output of fem_run. Forms are those of the textbook: the elements, their points and
the mass matrix are those of FEniCSx; laws that keep a history work on its quadrature points."""

import json
import sys

import numpy as np
import ufl
from dolfinx import fem, la, mesh
from mpi4py import MPI
import basix

CELL = {"tri3": "triangle", "quad4": "quadrilateral", "tet4": "tetrahedron", "hex8": "hexahedron"}
ORDER = {"tri3": [0, 1, 2], "quad4": [0, 1, 3, 2], "tet4": [0, 1, 2, 3],
         "hex8": [0, 1, 3, 2, 4, 5, 7, 6]}  # of the corners, from VTK's
# Components of a symmetric tensor as kept at the points: those that can be other than zero.
PAIRS = {2: [(0, 0), (1, 1), (2, 2), (0, 1)], 3: [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]}


class Body:
    def __init__(self, run):
        self.run, self.dim = run, run["dimension"]
        cell, order = CELL[run["shape"]], ORDER[run["shape"]]
        X = np.array(run["positions"]).reshape(-1, self.dim)
        cells = np.array(run["cells"]).reshape(-1, len(order))[:, order]
        self.domain = mesh.create_mesh(MPI.COMM_WORLD, cells, X,
                                       ufl.Mesh(ufl.VectorElement("Lagrange", cell, 1)))
        self.V = fem.VectorFunctionSpace(self.domain, ("Lagrange", 1))
        self.degree = 1 if run["shape"] in ("tri3", "tet4") else 2
        metadata = {"quadrature_degree": self.degree, "quadrature_scheme": "default"}
        self.ring = run["plane"] == "axisymmetric"
        self.radius = ufl.SpatialCoordinate(self.domain)[0]
        self.dx = ufl.dx(domain=self.domain, metadata=metadata)
        self.weight = 2 * np.pi * self.radius if self.ring else 1.0
        self.u, self.before = fem.Function(self.V), fem.Function(self.V)
        self.w = ufl.TestFunction(self.V)
        self.force = fem.Function(self.V)
        one = ufl.as_vector([1.0] * self.dim)
        density = run["density"] * self.weight
        self.mass = self.assemble(fem.form(density * ufl.inner(one, self.w) * self.dx))
        # Row of the input for every node here.
        geometry = self.domain.geometry
        given = np.array(geometry.input_global_indices)
        self.row = np.empty(len(X), dtype=int)
        for c in range(len(cells)):
            self.row[self.V.dofmap.cell_dofs(c)] = given[geometry.dofmap.links(c)]
        law = {"elastic": Elastic, "neo_hookean": NeoHookean, "j2": Incremental}[run["law"]]
        self.law = (Incremental if run["formulation"] == "one_point" else law)(self)

    def assemble(self, form):
        self.force.x.array[:] = 0
        fem.assemble_vector(self.force.x.array, form)
        self.force.x.scatter_reverse(la.ScatterMode.add)
        return self.force.x.array.reshape(-1, self.dim).copy()

    def gradient(self, v):
        """3 x 3, with the hoop of a ring."""
        G = ufl.grad(v)
        if self.dim == 3:
            return G
        hoop = v[0] / self.radius if self.ring else 0
        return ufl.as_tensor([[G[0, 0], G[0, 1], 0], [G[1, 0], G[1, 1], 0], [0, 0, hoop]])

    def displacement(self):
        run, dt = self.run, self.run["time_step"]
        v = np.array(run["velocity"]).reshape(-1, self.dim)[self.row]
        moved = np.isin(self.row, run["moved"])
        d = np.zeros_like(v)
        for step in range(run["steps"]):
            self.u.x.array[:] = d.ravel()
            a = -self.assemble(self.law.internal()) / self.mass
            v = v + (0.5 if step == 0 else 1.0) * dt * a
            v[moved] = run["moved_velocity"]
            d = d + dt * v
        result = np.empty_like(d)
        result[self.row] = d
        return result


class ElementMean:
    """Of a scalar or tensor, over the volume of each element."""

    def __init__(self, body, value, volume=1.0):
        shape = value.ufl_shape
        Q = (fem.TensorFunctionSpace(body.domain, ("Discontinuous Lagrange", 0), shape=shape) if shape
             else fem.FunctionSpace(body.domain, ("Discontinuous Lagrange", 0)))
        self.function = fem.Function(Q)
        one = fem.FunctionSpace(body.domain, ("Discontinuous Lagrange", 0))
        self.sum = fem.form(ufl.inner(value, ufl.TestFunction(Q)) * volume * body.weight * body.dx)
        self.volume = fem.form(ufl.TestFunction(one) * volume * body.weight * body.dx)

    def update(self):
        """-> [cells, size of the value]"""
        volume = fem.assemble_vector(self.volume).array
        mean = fem.assemble_vector(self.sum).array.reshape(len(volume), -1) / volume[:, None]
        self.function.x.array[:] = mean.ravel()
        return mean


class Elastic:
    def __init__(self, body):
        lam, mu = body.run["lambda"], body.run["mu"]
        if body.run["plane"] == "stress":
            lam = 2 * lam * mu / (lam + 2 * mu)
        strain, virtual = ufl.sym(body.gradient(body.u)), ufl.sym(body.gradient(body.w))
        volumetric = ufl.tr(strain)
        barred = body.run["formulation"] == "mean_dilatation"
        self.mean = ElementMean(body, volumetric) if barred else None
        pressure = (lam + 2 / 3 * mu) * (self.mean.function if self.mean else volumetric)
        work = 2 * mu * ufl.inner(ufl.dev(strain), virtual) + pressure * ufl.tr(virtual)
        self.form = fem.form(work * body.weight * body.dx)

    def internal(self):
        if self.mean:
            self.mean.update()
        return self.form


class NeoHookean:
    def __init__(self, body):
        F = ufl.variable(ufl.Identity(3) + body.gradient(body.u))
        C, J = F.T * F, ufl.det(F)
        lam, mu = body.run["lambda"], body.run["mu"]
        energy = mu / 2 * (ufl.tr(C) - 3) - mu * ufl.ln(J) + lam / 2 * ufl.ln(J)**2
        work = ufl.inner(ufl.diff(energy, F), body.gradient(body.w))
        self.form = fem.form(work * body.weight * body.dx)

    def internal(self):
        return self.form


class Incremental:
    """Elastic, or J2 with linear hardening and radial return; in finite strain with the increment in
    the middle of the step and the rotation of Hughes and Winget, half of it before the increment
    and half behind; the stress is Kirchhoff's. One point: the mean gradient over the element."""

    def __init__(self, body):
        self.body, self.first = body, True
        run, domain = body.run, body.domain
        self.finite = run["finite_strain"]
        self.cells = np.arange(domain.topology.index_map(domain.topology.dim).size_local, dtype=np.int32)
        self.pairs = PAIRS[body.dim]
        increment = body.gradient(body.u - body.before)
        virtual = body.gradient(body.w)
        volume = middle_volume = 1.0
        if self.finite:
            one = ufl.Identity(3)
            F, middle = one + body.gradient(body.u), one + body.gradient((body.u + body.before) / 2)
            increment, virtual = increment * ufl.inv(middle), virtual * ufl.inv(F)
            volume, middle_volume = ufl.det(F), ufl.det(middle)
        if run["formulation"] == "one_point":
            self.increment, points = ElementMean(body, increment, middle_volume), [0]
            Q = fem.VectorFunctionSpace(domain, ("Discontinuous Lagrange", 0), dim=len(self.pairs))
        else:
            cell = CELL[run["shape"]]
            points, _ = basix.make_quadrature(getattr(basix.CellType, cell), body.degree)
            self.increment = fem.Expression(increment, points)
            Q = fem.FunctionSpace(domain, ufl.VectorElement("Quadrature", cell, body.degree,
                                                            dim=len(self.pairs),
                                                            quad_scheme="default"))
        self.kept = fem.Function(Q)
        index = {pair: k for k, pair in enumerate(self.pairs)}

        def component(*pair):
            return self.kept[index[pair]] if pair in index else 0

        stress = ufl.as_tensor([[component(min(i, j), max(i, j)) for j in range(3)]
                                for i in range(3)])
        self.ratio = None  # of the volumes of an element, which a stress in one point acts in
        if run["formulation"] == "one_point":
            self.ratio = ElementMean(body, volume) if self.finite else None
            stress = stress / (self.ratio.function if self.ratio else 1.0)
        else:
            stress = stress / volume
        self.mean = self.mean_pressure = None
        if run["formulation"] == "mean_dilatation":
            self.mean = ElementMean(body, ufl.tr(increment), middle_volume)
            self.mean_pressure = ElementMean(body, ufl.tr(stress) / 3, volume)
            stress = ufl.dev(stress) + self.mean_pressure.function * ufl.Identity(3)
        self.form = fem.form(ufl.inner(stress, virtual) * volume * body.weight * body.dx)
        shape = (len(self.cells), len(points))
        self.stress, self.plastic = np.zeros((*shape, 3, 3)), np.zeros(shape)

    def internal(self):
        if not self.first:
            G = (self.increment.update() if isinstance(self.increment, ElementMean)
                 else self.increment.eval(self.cells))
            self.follow(G.reshape(*self.plastic.shape, 3, 3))
        self.first = False
        self.body.before.x.array[:] = self.body.u.x.array
        components = [self.stress[..., i, j] for i, j in self.pairs]
        self.kept.x.array[:] = np.stack(components, axis=-1).ravel()
        if self.ratio:
            self.ratio.update()
        if self.mean_pressure:
            self.mean_pressure.update()
        return self.form

    def follow(self, G):
        run, one = self.body.run, np.eye(3)
        strain = (G + G.swapaxes(-1, -2)) / 2
        if self.mean:
            self.mean.update()
            missing = self.mean.function.x.array[:, None] - np.trace(strain, axis1=-2, axis2=-1)
            strain = strain + missing[..., None, None] / 3 * one
        stress = self.stress
        if self.finite:
            spin = (G - G.swapaxes(-1, -2)) / 4  # half of it; its axial vector is tan(angle / 2)
            spin = spin / (1 + np.sqrt(1 + np.sum(spin**2, axis=(-2, -1)) / 2))[..., None, None]
            R = np.linalg.solve(one - spin, one + spin)
            stress = R @ stress @ R.swapaxes(-1, -2)
        lam, mu, H = run["lambda"], run["mu"], run["hardening_modulus"]
        trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
        stress = stress + lam * trace * one + 2 * mu * strain
        s = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3 * one
        q = np.sqrt(1.5 * np.sum(s * s, axis=(-2, -1)))
        strength = run["yield_stress"] + H * self.plastic if run["law"] == "j2" else np.inf
        dp = np.maximum(q - strength, 0) / (3 * mu + H)
        stress = stress - (3 * mu * dp / np.where(q > 0, q, 1))[..., None, None] * s
        self.stress = R @ stress @ R.swapaxes(-1, -2) if self.finite else stress
        self.plastic = self.plastic + dp


def main():
    with open(sys.argv[1]) as file:
        runs = json.load(file)
    output = {}
    for k, run in enumerate(runs):
        body = Body(run)
        output[f"displacement_{k}"] = body.displacement()
        if run["law"] == "j2":
            output[f"flowed_{k}"] = np.count_nonzero(body.law.plastic) / body.law.plastic.size
    np.savez(sys.argv[2], **output)


main()
