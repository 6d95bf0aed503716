"""Every call of dolfinx whose name or form differs between its versions, and nothing else.

Written against 0.5 and tested with it; the other branches follow the interfaces of later releases.
"""

import dolfinx
import mpi4py
import numpy as np
import petsc4py
import ufl
from dolfinx import cpp, fem, mesh
from dolfinx.fem import petsc as fem_petsc
from mpi4py import MPI
from petsc4py import PETSc


def versions():
    """Versions of the underlying libraries, by name."""
    return {
        "dolfinx": dolfinx.__version__,
        "petsc": ".".join(map(str, PETSc.Sys.getVersion())),
        "petsc4py": petsc4py.__version__,
        "mpi": MPI.Get_library_version().splitlines()[0].strip().strip("\0"),
        "mpi4py": mpi4py.__version__,
        "numpy": np.__version__,
    }


def hexahedral_mesh(comm, points, cells):
    """A distributed mesh of 27-node hexahedra.

    ``points`` (n, 3) and ``cells`` (m, 27), in gmsh's node order, are given whole on rank 0 and empty
    (with the same number of columns) on the others.
    """
    order = np.asarray(cpp.io.perm_gmsh(mesh.CellType.hexahedron, 27))
    cells = np.ascontiguousarray(cells[:, order], dtype=np.int64)
    if hasattr(fem, "functionspace"):
        import basix.ufl

        element = basix.ufl.element("Lagrange", "hexahedron", 2, shape=(3,))
        return mesh.create_mesh(comm, cells, points, element)
    cell = ufl.Cell("hexahedron", geometric_dimension=3)
    scalar = ufl.FiniteElement("Lagrange", cell, 2, variant="equispaced")
    return mesh.create_mesh(comm, cells, points, ufl.Mesh(ufl.VectorElement(scalar)))


def displacement_space(domain):
    """Continuous quadratic vectors with three components."""
    if hasattr(fem, "functionspace"):
        return fem.functionspace(domain, ("Lagrange", 2, (3,)))
    return fem.VectorFunctionSpace(domain, ("Lagrange", 2))


def evaluate_on_cells(expression, domain, cells):
    """Values of a fem.Expression on ``cells``, one row a cell."""
    try:
        return expression.eval(cells)
    except TypeError:
        return expression.eval(domain, cells)


def local_size(space):
    """Numbers of nodes owned by and known to this rank."""
    index_map = space.dofmap.index_map
    return index_map.size_local, index_map.size_local + index_map.num_ghosts


def geometry_nodes(domain):
    """Rows of the mesh's geometry that make up each local cell, (cells, 27)."""
    dofmap = domain.geometry.dofmap
    return dofmap if isinstance(dofmap, np.ndarray) else np.asarray(dofmap.array).reshape(-1, 27)


def direct_solver(comm):
    """PETSc's name of the sparse Cholesky factorisation to use on ``comm``.

    CHOLMOD if PETSc has it, for its better orderings than those of MUMPS in distributions;
    it supports one process only.
    """
    serial = comm.size == 1 and PETSc.Sys.hasExternalPackage("suitesparse")
    return "cholmod" if serial else "mumps"


def assemble_stiffness(form, conditions):
    """The assembled PETSc matrix of a bilinear form under Dirichlet conditions (unit diagonal there)."""
    matrix = fem_petsc.assemble_matrix(fem.form(form), bcs=conditions)
    matrix.assemble()
    return matrix


def assemble_vector(form):
    """The assembled PETSc vector of a linear form, contributions of all ranks added."""
    vector = fem_petsc.assemble_vector(fem.form(form))
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    return vector
