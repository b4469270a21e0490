"""3. The residual of an edge, and its Jacobians.

Task. An edge of the graph measured Z, the pose of node j in the frame of node i. Write the residual, and its Jacobians
for perturbations on the right, T ⊞ δ = T exp(δ), translation first.

Formula.

    e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)
    ∂e/∂δⱼ ≈ I        ∂e/∂δᵢ ≈ −Ad(Z⁻¹)

                    ( cos θ  −sin θ   y )
    Ad((x, y, θ)) = ( sin θ   cos θ  −x )
                    (   0       0     1 )

Both leave out a factor, Jᵣ⁻¹(e) at j and Jₗ⁻¹(e) at i, which is I if e is zero. Otherwise, the result moves by O(e²); a
wrong residual moves it by O(e) (exercise 3 of the page).

rustslam2d has compose, inverse and log.
"""

import numpy as np
import rustslam2d as rs


def residual(from_, to, z):
    """e in m, m, rad, shape (3,), for the poses `from_` (Tᵢ) and `to` (Tⱼ) and the measurement `z` (Z), shape (3,) each."""
    raise NotImplementedError("residual is not written yet: its task is in residual.py")


def jacobians(z):
    """(∂e/∂δᵢ, ∂e/∂δⱼ), shape (3, 3) each."""
    raise NotImplementedError("residual is not written yet: its task is in residual.py")
