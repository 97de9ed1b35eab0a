"""Limits of a flexible pipe as its maker states them (API 17J, ISO 13628-2).

A utilisation is what there is over what is allowed, and must not exceed 1.
"""

from __future__ import annotations

import numpy as np

from riser_soil.code_checks.collapse import Number
from riser_soil.core.arrays import Array


def bend_radius(curvature: Number, allowed_radius: Number) -> Array:
    """Curvature [1/m] times the least bend radius allowed [m]: that of storage, static or dynamic service.

    Source: API 17J (2008), least bend radius in storage and service.
    """
    return np.asarray(curvature * allowed_radius)


def tension(effective: Number, allowed: Number) -> Array:
    """Effective tension over the largest allowed [N]; 0 in compression."""
    return np.asarray(np.maximum(effective, 0.0) / allowed)


def compression(effective: Number, allowed: Number) -> Array:
    """Effective compression over the largest allowed [N]; 0 in tension."""
    return np.asarray(np.maximum(np.negative(effective), 0.0) / allowed)


def crushing(contact_force: Number, allowed: Number) -> Array:
    """Contact force per length of pipe over the largest allowed [N/m]; 0 where the ground holds the pipe down."""
    return np.asarray(np.maximum(contact_force, 0.0) / allowed)
