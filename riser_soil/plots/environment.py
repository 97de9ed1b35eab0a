"""Matplotlib plots of what acts on a riser: current by height, wave spectra, and a vessel's RAOs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import PAGE, sheet

_SEPARATE = 4  # directions of RAOs that are drawn
_LOWEST, _HIGHEST = 0.4, 3.5  # of the peak frequency: between which a spectrum is drawn


def current_sheet(profiles: Mapping[str, Array], surface: float | None) -> Figure:
    """Speed of currents over the height: profiles (n, 3) of z [m], ux, uy [m/s] by name."""
    figure, (axes,) = sheet(1, 1, width=0.6 * PAGE, height=3.0)
    for name, profile in profiles.items():
        speed = np.hypot(profile[:, 1], profile[:, 2])
        axes.plot(speed, profile[:, 0], "o-", markersize=3.0, label=name)
    if surface is not None:
        axes.axhline(surface, color="C0", linewidth=0.8, linestyle="-.", label="water surface")
    axes.set(xlabel="speed of the current [m/s]", ylabel="height above z = 0 [m]", xlim=(0.0, None))
    axes.legend()
    return figure


def peaked_spectrum(Hs: float, Tp: float, gamma: float) -> tuple[Array, Array]:
    """Frequencies [Hz] and density [m2/Hz] of a sea by its height [m], peak period [s] and enhancement factor."""
    from riser_soil.sea.spectra import spectrum

    f = np.linspace(_LOWEST, _HIGHEST, 400) / Tp
    return f, 2.0 * math.pi * spectrum(2.0 * math.pi * f, Hs, Tp, gamma)


def spectrum_sheet(seas: Mapping[str, tuple[Array, Array]]) -> Figure:
    """Spectra of irregular seas by name: frequencies [Hz] and density [m2/Hz] of each."""
    figure, (axes,) = sheet(1, 1, width=PAGE, height=2.4)
    for name, (f, density) in seas.items():
        axes.plot(f, density, label=name)
    axes.set(xlabel="frequency [Hz]", ylabel="spectral density [m²/Hz]", ylim=(0.0, None))
    axes.legend()
    return figure


def rao_sheet(
    frequency: Sequence[float], direction: Sequence[float], response: Mapping[str, Array], chosen: Sequence[int]
) -> Figure:
    """Amplitudes over the period, a panel for each mode that responds.

    frequency: (nf,) rad/s; direction: (nd,) rad; response: (nd, nf) by mode, [m/m] and [rad/m]; chosen: numbers of the
    directions that are drawn, at most four of them.
    """
    figure, panels = sheet(-(-len(response) // 2), 2, width=PAGE, height=1.9)
    period = 2.0 * math.pi / np.asarray(frequency)
    for axes, (mode, table) in zip(panels, response.items(), strict=False):
        turns = mode in ("roll", "pitch", "yaw")
        for n in chosen[:_SEPARATE]:
            size = np.abs(table[n]) * (math.degrees(1.0) if turns else 1.0)
            axes.plot(period, size, label=f"{math.degrees(direction[n]):.4g}°")
        axes.set(xlabel="period [s]", ylabel=f"{mode} [{'°/m' if turns else 'm/m'}]", ylim=(0.0, None))
    panels[0].legend(title="waves from the heading", title_fontsize=7.5)
    for axes in panels[len(response) :]:
        axes.remove()
    return figure
