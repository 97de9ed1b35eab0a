"""The worked case of a law of one's own: resistance to a pipe beside von Mises clay of the same strength and a formula.

Usage, in the project's folder: python -m demos.own_law.run [--results FOLDER] [--page]
Leaves the table in `results` beside this file; --page writes it where README.md shows it.
"""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from demos.page import publish, script, table
from riser_soil import Scene, run
from riser_soil.core.arrays import Array
from riser_soil.scene.soil import SoilScene

HERE = Path(__file__).parent
PAGE = HERE / "README.md"
DEPTHS = (0.02, 0.05, 0.1)  # over D, at the ends of the scene's stages


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    scene = Scene.from_file(HERE / "scene.yaml")
    publish({"resistance": resistance_page(scene)}, results, PAGE if page else None)


def soil_of(scene: Scene) -> SoilScene:
    soil = scene.model.soil
    assert soil is not None
    return soil


def strength(scene: Scene) -> tuple[float, float]:
    """Undrained strength at the seabed [Pa] and its growth with depth [Pa/m].

    At constant volume the effective pressure goes from p to p (OCR/2)^(1 - kappa/lam), where q = M p, and q = √3 su.
    """
    law = soil_of(scene).top_law.model_dump()
    ratio = law["M"] / math.sqrt(3.0) * (0.5 * law["OCR"]) ** (1.0 - law["kappa"] / law["lam"])
    return ratio * law["attraction"], ratio * soil_of(scene).submerged_unit_weight


def as_von_mises(scene: Scene) -> dict[str, Any]:
    """The clay of the same strength, and of the same shear modulus, G_over_p times the pressure."""
    su, gradient = strength(scene)
    law = soil_of(scene).top_law.model_dump()
    E_over_su = 2.0 * 1.49 * law["G_over_p"] * law["attraction"] / su
    return {"kind": "von-mises", "su": su, "su_gradient": gradient, "E_over_su": E_over_su, "nu": 0.49}


def resistance(scene: Scene) -> Array:
    """V/D [Pa] at the ends of the stages."""
    with TemporaryDirectory() as folder:
        V = run(scene, Path(folder) / "run", quiet=True).dataset["contact_force_sum"][:, 2].values
    block = soil_of(scene).given_block
    assert block is not None
    low, high = block.x
    return np.asarray(V / (high - low) / scene.model.largest_diameter)


def resistance_page(scene: Scene) -> str:
    su, _ = strength(scene)
    clays = {"my_clay.py": scene, "von-mises of the same su": scene.changed({"soil.law": as_von_mises(scene)})}
    rows = [[name, *(f"{V:.2f}" for V in resistance(clay) / su)] for name, clay in clays.items()]
    rows.append(["Merifield et al., smooth", *(f"{5.3 * depth**0.25:.2f}" for depth in DEPTHS)])
    return table(["V/(su D) at w/D", *(f"{depth:g}" for depth in DEPTHS)], rows)


if __name__ == "__main__":
    script(main, __doc__, HERE)
