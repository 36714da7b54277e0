"""How far the teeth's face gives way to loads that vary around the axis, harmonic by harmonic.

A load that goes with the angle θ as cos nθ moves a body of revolution by u_r = U sin nθ, u_θ = V cos nθ and
u_z = W sin nθ, so that three functions on the half-section take the place of a solid. The finite elements are
scikit-fem's quadrilaterals of second order, whose stiffness K₀ + n K₁ + n² K₂ is put together once for all n.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flexlash.mechanics.elasticity.half_section import HalfSection
from flexlash.mechanics.elasticity.section_mesh import face_shares, section_mesh
from flexlash.schema.arrays import Array

__all__ = ["Lobes", "lobes_of"]

_RADIAL, _AROUND, _AXIAL = range(3)
"""Places of U, V and W among the three numbers of a node."""


@dataclass(frozen=True, kw_only=True)
class Lobes:
    """The equations of a half-section for loads that vary around the axis, Young's modulus being 1.

    `stiffness` are K₀, K₁ and K₂, sparse, three numbers a node; `load` [m²] is the even traction on the teeth's face;
    `free` are the numbers that the hub does not hold; `radial` gives the number of U at a node of the lattice; `area`
    [m²] and `moment` [m³] are the face's ∫ r dz and ∫ r² dz.
    """

    stiffness: tuple[Any, Any, Any]
    load: Array
    free: Any
    radial: Any
    area: float
    moment: float

    def even_windup(self) -> float:
        """Return the wind-up times Young's modulus over the torque [1/m³] where the load is even.

        Equation: U₀ = c₀ A/(2π t²), A = ∫ r dz, t = ∫ r² dz; c₀ as of `compliances`
        """
        return self._even * self.area / (2 * np.pi * self.moment**2)

    def compliances(self, harmonics: Iterable[int], held: Any) -> Array:
        """Return how much more the face gives way to the load cos nθ than to the even one [-], for each n ≥ 2.

        Equation: ρ_n = c_n/c₀, c_n = fᵀV/A with (K₀ + n K₁ + n² K₂) (U, V, W) = f; for c₀ V alone
        Arguments: harmonics n; `held` marks the nodes of the lattice that a wave generator holds: there U = 0.
        """
        is_free = np.ones(len(self.load), dtype=bool)
        is_free[self.radial[held]] = False
        return np.array(self._yielding(harmonics, self.free[is_free[self.free]])) / self._even

    @cached_property
    def _even(self) -> float:
        """How far the face gives way to the even load [m]."""
        return self._yielding([0], self.free[self.free % 3 == _AROUND])[0]

    def _yielding(self, harmonics: Iterable[int], free: Any) -> list[float]:
        """Return fᵀV/A for each harmonic, where only some numbers are free."""
        from scipy.sparse.linalg import splu

        blocks, load = [matrix[free][:, free].tocsc() for matrix in self.stiffness], self.load[free]

        def one(harmonic: int) -> float:
            matrix = blocks[0] + harmonic * blocks[1] + harmonic * harmonic * blocks[2]
            # Positive definite, so that no pivot is sought. LAPACK's band solver is faster on one idle core alone.
            factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
            return float(load @ factor.solve(load)) / self.area

        return [one(harmonic) for harmonic in harmonics]


def lobes_of(section: HalfSection, poisson_ratio: float) -> Lobes:
    """Return the equations of a half-section whose teeth's face is loaded.

    Equation: ε_rr = U,r; ε_zz = W,z; ε_θθ = (U − nV)/r; γ_rz = U,z + W,r; γ_rθ = nU/r + V,r − V/r; γ_zθ = V,z + nW/r;
        K = ∫ εᵀ D ε r dr dz, D isotropic with E = 1; f = ∫ N r dz on V over the face
    Valid: linear elasticity, 0 ≤ ν < 0.5.
    """
    mesh, number = section_mesh(section)
    stiffness = _stiffness(mesh, poisson_ratio)
    is_free = np.ones((len(mesh.doflocs.T), 3), dtype=bool)
    is_free[number[section.clamped]] = False
    shares = (face_shares(section) * section.radius)[section.loaded]
    load = np.zeros(is_free.size)
    load[3 * number[section.loaded] + _AROUND] = shares
    return Lobes(
        stiffness=stiffness,
        load=load,
        free=np.nonzero(is_free.ravel())[0],
        radial=3 * number + _RADIAL,
        area=float(shares.sum()),
        moment=float(shares @ section.radius[section.loaded]),
    )


def _stiffness(mesh: Any, poisson_ratio: float) -> tuple[Any, Any, Any]:
    """Return K₀, K₁ and K₂ of a mesh as sparse matrices, the numbers of a node side by side."""
    from scipy.sparse import csr_matrix
    from skfem import Basis, ElementQuad2

    basis = Basis(mesh, ElementQuad2(), intorder=4)
    even, lobed = _strains(basis)
    radius = np.asarray(basis.global_coordinates())[0]
    law = _isotropic_law(poisson_ratio) * (basis.dx * radius)[:, :, None, None]
    cells, points, _, count = even.shape
    even_stress, lobed_stress = law @ even, law @ lobed

    def product(strain: Array, stress: Array) -> Array:
        strain, stress = (field.reshape(cells, points * 6, count) for field in (strain, stress))
        return np.asarray(strain.transpose(0, 2, 1) @ stress)

    mixed = product(even, lobed_stress)
    numbers = (3 * basis.element_dofs.T[:, :, None] + np.arange(3)).reshape(cells, count)
    rows, columns = (
        np.broadcast_to(side, (cells, count, count)).ravel() for side in (numbers[:, :, None], numbers[:, None])
    )

    def whole(blocks: Array) -> Any:
        return csr_matrix((blocks.ravel(), (rows, columns)), shape=(3 * basis.N, 3 * basis.N))

    return (
        whole(product(even, even_stress)),
        whole(mixed + mixed.transpose(0, 2, 1)),
        whole(product(lobed, lobed_stress)),
    )


def _strains(basis: Any) -> tuple[Array, Array]:
    """Return the strains rr, zz, θθ, rz, rθ, zθ of each shape function for n = 0, and what each n adds n times.

    Both have the shape (cells, points, 6, numbers).
    """
    shapes = [function[0] for function in basis.basis]
    values = np.stack([np.broadcast_to(np.asarray(shape), basis.dx.shape) for shape in shapes], axis=-1)
    along_radius, along_axis = np.stack([shape.grad for shape in shapes], axis=-1)
    hoop = values / np.asarray(basis.global_coordinates())[0][..., None]
    even = np.zeros((*basis.dx.shape, 6, len(shapes), 3))
    lobed = np.zeros_like(even)
    even[:, :, 0, :, _RADIAL] = along_radius
    even[:, :, 1, :, _AXIAL] = along_axis
    even[:, :, 2, :, _RADIAL], lobed[:, :, 2, :, _AROUND] = hoop, -hoop
    even[:, :, 3, :, _RADIAL], even[:, :, 3, :, _AXIAL] = along_axis, along_radius
    even[:, :, 4, :, _AROUND], lobed[:, :, 4, :, _RADIAL] = along_radius - hoop, hoop
    even[:, :, 5, :, _AROUND], lobed[:, :, 5, :, _AXIAL] = along_axis, hoop
    flat = (*basis.dx.shape, 6, 3 * len(shapes))
    return even.reshape(flat), lobed.reshape(flat)


def _isotropic_law(poisson_ratio: float) -> Array:
    """Return stress per strain (6, 6) where Young's modulus is 1."""
    shear = 1 / (2 * (1 + poisson_ratio))
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    return law
