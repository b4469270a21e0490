"""3. The residual of an edge, and its Jacobians."""

import numpy as np
import rustslam2d as rs


def residual(from_, to, z):
    """e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)."""
    return rs.log(rs.compose(rs.inverse(z), rs.compose(rs.inverse(from_), to)))


def jacobians(z):
    """(−Ad(Z⁻¹), I)."""
    x, y, theta = rs.inverse(z)
    cos, sin = np.cos(theta), np.sin(theta)
    adjoint = np.array([[cos, -sin, y], [sin, cos, -x], [0.0, 0.0, 1.0]])
    return -adjoint, np.eye(3)
