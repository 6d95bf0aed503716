"""One elastic body: its stiffness, the compliance of its contact nodes, and stresses inside it."""

import itertools
import time

import numpy as np
import ufl
from dolfinx import fem, mesh
from petsc4py import PETSc

from . import compat
from .meshing import read_msh
from .recovery import StressField
from .request import FemError

# Exact for the polynomial part of a quadratic hexahedron's stiffness on a parallelepiped.
_QUADRATURE = {"quadrature_degree": 4}

# The largest part of a load that a solve may leave without balance; direct solvers leave 1e-11 and less.
_RESIDUAL = 1e-6

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def load_mesh(comm, path):
    """The mesh in a gmsh file, read by rank 0 and spread over the ranks of ``comm``."""
    points, cells, failure = np.zeros((0, 3)), np.zeros((0, 27), dtype=np.int64), None
    if comm.rank == 0:
        try:
            points, cells, _ = read_msh(path)
        except FemError as error:
            failure = str(error)
    failure = comm.bcast(failure)
    if failure is not None:
        raise FemError(failure)
    return compat.hexahedral_mesh(comm, points, cells)


class Body:
    """An elastic body on its supports, loaded by forces normal to its surface at its contact nodes.

    ``domain``: its mesh; ``young`` (units of p0) and ``poisson``: its material; ``fixed``: pairs
    ``(component, on)`` that hold a displacement component at zero where ``on(x)`` is true, x being of
    shape (3, n), on the body's surface; ``pinned``: the same for single nodes anywhere. Together they must
    exclude rigid motion, so that the stiffness is positive definite. ``linear`` is ``direct`` or
    ``iterative``, ``tolerance`` the latter's.

    Attributes: ``seconds`` by stage; ``factorised_by``, the direct solver's name or ``None``; ``iterations``
    and ``solves`` so far.
    """

    def __init__(self, domain, young, poisson, fixed, linear="direct", tolerance=1e-10, pinned=()):
        self.domain = domain
        self.comm = domain.comm
        self.young, self.poisson = young, poisson
        self.seconds = {}
        began = time.perf_counter()
        self.space = compat.displacement_space(domain)
        self._owned, self._known = compat.local_size(self.space)
        self.nodes = self.space.tabulate_dof_coordinates()[: self._known]
        self._mu = fem.Constant(domain, PETSc.ScalarType(0.5 * young / (1.0 + poisson)))
        self._lame = fem.Constant(
            domain, PETSc.ScalarType(young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)))
        )
        self.displacement = fem.Function(self.space)
        conditions, self._held = [], {}
        boundary = domain.topology.dim - 1
        for component, on in fixed:
            facets = mesh.locate_entities_boundary(domain, boundary, on)
            dofs = fem.locate_dofs_topological(self.space.sub(component), boundary, facets)
            conditions.append(fem.dirichletbc(PETSc.ScalarType(0), dofs, self.space.sub(component)))
            held = self._held.setdefault(component, set())
            held.update(int(d) for d in dofs if d < 3 * self._owned)
        for component, on in pinned:
            dofs = (3 * np.flatnonzero(on(self.nodes.T)) + component).astype(np.int32)
            conditions.append(fem.dirichletbc(PETSc.ScalarType(0), dofs, self.space.sub(component)))
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        volume = ufl.Measure("dx", domain=domain, metadata=_QUADRATURE)
        energy = ufl.inner(self._stress(trial), self._strain(test)) * volume
        self.matrix = compat.assemble_stiffness(energy, conditions)
        self.matrix.setOption(PETSc.Mat.Option.SPD, True)
        self.seconds["assemble"] = time.perf_counter() - began
        began = time.perf_counter()
        self._solver = self._make_solver(linear, tolerance)
        self.seconds["factor"] = time.perf_counter() - began
        self.iterations = 0
        self.solves = 0
        self._load = self.matrix.createVecRight()
        self._answer = self.matrix.createVecRight()
        self._balance = self.matrix.createVecRight()
        self._contact = self._tilt = None

    def _strain(self, u):
        return ufl.sym(ufl.grad(u))

    def _stress(self, u):
        strain = self._strain(u)
        return 2.0 * self._mu * strain + self._lame * ufl.tr(strain) * ufl.Identity(3)

    def _make_solver(self, linear, tolerance):
        self.factorised_by = None
        solver = PETSc.KSP().create(self.comm)
        solver.setOperators(self.matrix)
        prefix = f"body_{id(self)}_"
        solver.setOptionsPrefix(prefix)
        self.matrix.setOptionsPrefix(prefix)
        options = PETSc.Options(prefix)
        if linear == "direct":
            solver.setType("preonly")
            preconditioner = solver.getPC()
            preconditioner.setType("cholesky")
            self.factorised_by = compat.direct_solver(self.comm)
            preconditioner.setFactorSolverType(self.factorised_by)
            if self.factorised_by == "mumps":
                # It underestimates its workspace on stretched meshes.
                options["mat_mumps_icntl_14"] = 60
        else:
            solver.setType("cg")
            solver.setTolerances(rtol=tolerance, max_it=5000)
            options["pc_type"] = "hypre"
            options["pc_hypre_type"] = "boomeramg"
            # Far elements are up to a thousand times longer than wide. Only a high threshold coarsens along
            # the strong couplings alone; aggregation does not, whatever modes it is given.
            options["pc_hypre_boomeramg_strong_threshold"] = 0.8
        solver.setFromOptions()
        try:
            solver.setUp()
        except PETSc.Error as error:
            raise FemError(f"the {linear} solver failed to set up ({error})") from error
        factored = solver.getPC().getFactorMatrix() if self.factorised_by == "mumps" else None
        if factored is not None and factored.getMumpsInfog(1) < 0:
            raise FemError("MUMPS failed to factor a stiffness matrix (out of memory?)")
        return solver

    def _numbered(self, count, find):
        """This rank's own nodes among ``count`` that ``find`` numbers: (their rows, their numbers, ``count``).

        ``find(nodes)`` maps coordinates (n, 3) to numbers in [0, ``count``), or -1 for nodes that are not
        meant. Raises :class:`FemError` for numbers that are missing or found twice, over all ranks.
        """
        numbers = find(self.nodes[: self._owned])
        rows = np.flatnonzero(numbers >= 0)
        found = np.zeros(count, dtype=np.int64)
        np.add.at(found, numbers[rows], 1)
        self.comm.Allreduce(found.copy(), found)
        if np.any(found != 1):
            raise FemError(
                f"{np.count_nonzero(found != 1)} of {count} nodes are missing from the mesh or stand twice in it"
            )
        return rows, numbers[rows], count

    def _gathered(self, numbered, values):
        """A whole array over ``numbered`` nodes from this rank's values, one for each of its own."""
        _, numbers, count = numbered
        whole = np.zeros(count)
        whole[numbers] = values
        self.comm.Allreduce(whole.copy(), whole)
        return whole

    def number_contact_nodes(self, count, find, slope=None):
        """Tell the body its contact nodes, of which ``find(nodes)`` gives the numbers in [0, ``count``).

        ``slope(x)`` is dz/dx of the unloaded surface at coordinates x (n,); left out for a plane surface
        z = 0. Raises :class:`FemError` for numbers that are missing or found twice.
        """
        self._contact = self._numbered(count, find)
        rows = self._contact[0]
        self._tilt = np.zeros(len(rows)) if slope is None else slope(self.nodes[rows, 0])

    def contact_coordinates(self, axis):
        """Coordinate ``axis`` of every contact node."""
        return self._gathered(self._contact, self.nodes[self._contact[0], axis])

    def displacement_at(self, component, places):
        """Displacement component of the last solve at nodes at the ``places`` (n, 3); they must exist."""
        def find(nodes):
            near = [np.flatnonzero(np.abs(nodes - place).max(axis=1) < 1e-7 * (1.0 + np.abs(place).max()))
                    for place in places]
            numbers = np.full(len(nodes), -1)
            for number, rows in enumerate(near):
                numbers[rows] = number
            return numbers

        numbered = self._numbered(len(places), find)
        return self._gathered(numbered, self._answer.array[3 * numbered[0] + component])

    def press(self, forces):
        """Sinking of the surface at its contact nodes (units of C) under nodal ``forces`` normal to it.

        Both are measured along z: a node's force has the z component given and whatever x component makes it
        normal to the unloaded surface z = h(x), and its sinking is that of the surface at fixed x,
        u_z - h'(x) u_x. The two are conjugate, so that the compliance is symmetric.
        """
        first, answer = self._solve(forces, lambda own: (-self._tilt * own, own))
        return self._gathered(self._contact, answer[first + 2] - self._tilt * answer[first])

    def drag(self, forces):
        """Load the body with nodal ``forces`` along its surface, towards +x; they are the x components."""
        self._solve(forces, lambda own: (own, self._tilt * own))

    def _solve(self, forces, components):
        """Solve for nodal loads, the x and z ``components`` of ``forces``; returns the contact nodes' first rows of
        the answer, and the answer."""
        rows, numbers, _ = self._contact
        first = 3 * rows
        self._load.set(0.0)
        self._load.array[first], self._load.array[first + 2] = components(forces[numbers])
        self._solver.solve(self._load, self._answer)
        if self._solver.getConvergedReason() < 0:
            raise FemError(
                f"the linear solver did not converge (PETSc reason {self._solver.getConvergedReason()}, "
                f"{self._solver.getIterationNumber()} iterations)"
            )
        self.matrix.mult(self._answer, self._balance)
        self._balance.axpy(-1.0, self._load)
        residual = self._balance.norm()
        if not residual <= _RESIDUAL * self._load.norm():
            raise FemError(f"a solve of the finite elements left {residual / self._load.norm():.1e} of its load without "
                           "balance: run it again, and check this machine's memory if that recurs")
        self.iterations += self._solver.getIterationNumber()
        self.solves += 1
        return first, self._answer.array

    def forget_solver(self):
        """Free the memory of the factored stiffness; the state stays."""
        self._solver.destroy()
        self.matrix.destroy()

    def keep(self, component=2):
        """Make the last solve the body's state; returns the force that its supports carry along ``component``."""
        self.displacement.x.array[: 3 * self._owned] = self._answer.array
        self.displacement.x.scatter_forward()
        test = ufl.TestFunction(self.space)
        volume = ufl.Measure("dx", domain=self.domain, metadata=_QUADRATURE)
        inner = compat.assemble_vector(
            ufl.inner(self._stress(self.displacement), self._strain(test)) * volume
        )
        held = np.fromiter(self._held[component], dtype=np.int64, count=len(self._held[component]))
        return self.comm.allreduce(-float(inner.array[held].sum()))

    def stress_field(self, **options):
        """The :class:`~edgeline_fem.recovery.StressField` of the state that :meth:`keep` left, with its options."""
        stress = self._stress(self.displacement)
        x = ufl.SpatialCoordinate(self.domain)
        wanted = [x[0], x[1], x[2], *(stress[i, j] for i, j in _PAIRS)]
        at = np.array(list(itertools.product((0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5), repeat=3)))
        cells = np.arange(self.domain.topology.index_map(3).size_local, dtype=np.int32)
        expression = fem.Expression(ufl.as_vector(wanted), at)
        values = compat.evaluate_on_cells(expression, self.domain, cells).reshape(len(cells), 8, 9)
        # The vertices are the first eight of an element's nodes.
        corners = self.domain.geometry.x[compat.geometry_nodes(self.domain)[: len(cells), :8]]
        gathered = [np.concatenate(self.comm.allgather(part)) for part in (values, corners)]
        return StressField(gathered[0][:, :, :3], gathered[0][:, :, 3:], gathered[1], **options)
