"""Study of the first scene against a run much finer than all of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.on_ranks import ROOT

SCENE = ROOT / "demos" / "first_scene.yaml"
FINE = (4.0, 16.0)  # times the scene's elements and steps: beyond every level


@pytest.mark.verify
def test_references_hold_what_a_much_finer_run_finds(tmp_path: Path) -> None:
    """Each reference is off that run by its own uncertainty at most, and so are the errors that settings claim."""
    # Imported here: what pytest imports to collect tests would start MPI in the process whose children run them.
    from riser_soil.accuracy.study import study
    from riser_soil.scene.reader import read_scene

    made = study(read_scene(SCENE), tmp_path / "study", echo=lambda _: None)
    quantities = made.quantities()
    made.compute([FINE], 1)
    fine = made.outcomes.pop(FINE)
    for key, each in quantities.items():
        off, doubt = each.error_of(fine.key_results[key]), each.relative_uncertainty
        print(f"{key}: scene {each.error:.3%} off, reference {off:.4%} off the fine run, uncertainty {doubt:.4%}")
    assert fine.done
    assert len(made.judged()) == len(quantities) >= 15
    for key, each in quantities.items():
        assert each.error_of(fine.key_results[key]) <= each.relative_uncertainty + 1e-5
    for target in (0.01, 0.001):
        reached = made.reaching(target)
        assert reached is not None
        true = {
            key: abs(fine.key_results[key].value - result.value) / quantities[key].reference.scale
            for key, result in reached.key_results.items()
        }
        print(
            f"{target:.1%} by {made.refinements.in_words(reached.factors)}: {max(true.values()):.4%} off the fine run"
        )
        assert max(true.values()) <= 1.2 * target
    assert made.error(made.scene)[0] < 0.002
