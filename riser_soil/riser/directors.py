"""Node orientations (directors): unit tangents at element ends from rotation dofs, in the plane and in space.

`PlanarFrames` keeps an angle per node, `SpatialFrames` a rotation matrix. Each gives the trial orientation
for a rotation increment as a turn with the same members:

    tangent   unit tangents t at both ends of each element (ne, 2, d)
    P         dt/dTheta (ne, 2, d, r)
    motion    q' and q'' from the rates and accelerations of the dofs; see `hermite`
    geometric derivative of P^T F with respect to Theta at fixed F

R is the identity in the unstressed configuration. With body-axes angular velocity W and acceleration A,
t = R t0, t' = R (W x t0), t'' = R (A x t0 + W x (W x t0)).
"""

from riser_soil.riser.planar_directors import PlanarFrames, PlanarOrientation
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation

Frames = PlanarFrames | SpatialFrames
Orientation = PlanarOrientation | SpatialOrientation
