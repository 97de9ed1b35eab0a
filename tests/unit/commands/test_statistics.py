"""Statistics of outputs in time against closed forms, and the command on runs whose records are known."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.statistics.analysis import PlaceStatistics, Wanted
from riser_soil.statistics.extremes import fit_gumbel, fit_weibull, plotting_positions, rayleigh_height
from riser_soil.statistics.records import records_of
from riser_soil.statistics.series import block_maxima, cycles, spectrum
from tests.support.said import line_with, telling

STEP, PERIOD, AMPLITUDE, MEAN = 0.25, 8.0, 3.0, 10.0
F0, WIDTH = 0.1, 0.02  # Hz: a narrow band of frequencies, whose waves forget each other after some cycles


def gaussian(seed: int, n: int = 2**17, deviation: float = 1.0) -> Array:
    """A Gaussian process at STEP, its spectrum a normal distribution about F0: m0 = s2, m2 = s2 (F0^2 + WIDTH^2)."""
    f = np.fft.rfftfreq(n, STEP)
    S = np.exp(-0.5 * ((f - F0) / WIDTH) ** 2)
    rng = np.random.default_rng(seed)
    parts = np.sqrt(S) * (rng.standard_normal(f.size) + 1j * rng.standard_normal(f.size))
    return np.asarray(np.fft.irfft(parts, n) * deviation * n / np.sqrt(4.0 * S.sum()))


def analysed(*runs: Array, duration: float = 10800.0, **more: Any) -> PlaceStatistics:
    return PlaceStatistics(runs, STEP, Wanted(duration, **more))


def test_sine() -> None:
    t = STEP * np.arange(4 * 320)
    result = analysed(MEAN + AMPLITUDE * np.sin(2.0 * np.pi * (t - STEP) / PERIOD), duration=800.0)
    assert result.mean == pytest.approx(MEAN)
    assert result.deviation == pytest.approx(AMPLITUDE / np.sqrt(2.0))
    assert result.period == pytest.approx(PERIOD)
    assert result.peaks == pytest.approx(np.full(39, MEAN + AMPLITUDE))
    assert result.rayleigh == pytest.approx(MEAN + AMPLITUDE / np.sqrt(2.0) * np.sqrt(2.0 * np.log(100.0)))
    assert np.isnan(result.weibull.value)  # peaks of one height have no distribution
    assert result.spectrum.moment(0) == pytest.approx(AMPLITUDE**2 / 2.0, rel=1e-2)
    assert result.spectrum.frequency[result.spectrum.density.argmax()] == pytest.approx(1.0 / PERIOD)


def test_crossings_and_peaks_of_a_broken_line() -> None:
    """Up through zero at 0.5, 2.75 and 6.5 steps; largest in between 1 and 3, what comes after the last left out."""
    counted = cycles(np.array([-1.0, 1.0, -3.0, 1.0, 3.0, -2.0, -1.0, 1.0, 5.0]), 2.0, 0.0)
    assert counted.number == 2
    assert counted.time == pytest.approx(2.0 * (6.5 - 0.5))
    assert counted.period == pytest.approx(6.0)
    assert counted.peaks.tolist() == [1.0, 3.0]
    assert np.isnan(cycles(np.ones(9), 2.0, 0.0).period)


def test_peaks_are_above_the_level() -> None:
    """A value that touches the level from below is none, nor are peaks of one height a distribution."""
    assert cycles(np.array([-1.0, 0.0, -1.0, 2.0] * 3), 2.0, 0.0).peaks.tolist() == [2.0, 2.0]
    for height in (1.0, 3.0):
        assert np.isnan(fit_weibull(height * (1.0 + 1e-16 * np.arange(20.0))).shape)


def test_runs_of_unlike_lengths_make_blocks_of_the_shortest() -> None:
    x = gaussian(3, 2**13)
    pieces = analysed(*x.reshape(8, -1))
    unlike = analysed(x[:1024], x[1024:3072], x[3072:])
    assert unlike.maxima == pytest.approx(pieces.maxima)
    assert unlike.gumbel == pytest.approx(pieces.gumbel)


def test_blocks_are_whole() -> None:
    x = np.array([1.0, 5.0, 2.0, 7.0, 0.0, 3.0, 9.0])
    assert block_maxima(x, 2.0, 4.0).tolist() == [5.0, 7.0, 3.0]
    assert block_maxima(x, 2.0).tolist() == [9.0]


def test_gaussian_process_has_the_moments_of_its_spectrum() -> None:
    x, m0, m2 = gaussian(1, deviation=2.0), 4.0, 4.0 * (F0**2 + WIDTH**2)
    result = analysed(x)
    error = 1.0 / np.sqrt(2.0 * np.sqrt(np.pi) * WIDTH * len(x) * STEP)  # relative, of the variance's estimate
    assert result.deviation**2 == pytest.approx(m0, rel=3.0 * error)
    assert result.period == pytest.approx(np.sqrt(m0 / m2), rel=0.01)
    assert spectrum(x, STEP, 1000.0).period == pytest.approx(np.sqrt(m0 / m2), rel=0.01)
    assert spectrum(x, STEP, 1000.0).moment(0) == pytest.approx(result.deviation**2, rel=0.02)


def test_peaks_of_a_narrow_band_follow_rayleigh() -> None:
    """Weibull's distribution of shape 2 and scale sqrt(2) s; so both foretell the same largest value."""
    result = analysed(gaussian(2, deviation=2.0))
    assert len(result.peaks) > 3000
    assert result.weibull_fit.shape == pytest.approx(2.0, rel=0.06)
    assert result.weibull_fit.scale == pytest.approx(2.0 * np.sqrt(2.0), rel=0.04)
    assert result.weibull.value == pytest.approx(result.rayleigh, rel=0.05)
    assert result.weibull.low < result.weibull.value < result.weibull.high


def test_maxima_of_seeds_are_those_that_rayleigh_foretells() -> None:
    runs = [gaussian(seed, 2**14) for seed in range(3, 43)]
    result = analysed(*runs, duration=2**14 * STEP, confidence=0.99)
    assert result.maxima.tolist() == [x.max() for x in runs]
    assert result.gumbel.low < rayleigh_height(1.0, 2**14 * STEP * np.sqrt(F0**2 + WIDTH**2)) < result.gumbel.high
    longer = analysed(*runs, duration=10.0 * 2**14 * STEP).gumbel.value
    assert longer == pytest.approx(result.gumbel.value + result.gumbel_fit.scale * np.log(10.0))


@pytest.mark.parametrize(("count", "k"), [(5, 2.0), (30, 0.0), (137, 6.0)])
def test_intervals_of_gumbels_fit_are_right_as_often_as_they_say(count: int, k: float) -> None:
    location, scale, tries, confidence = 40.0, 3.0, 300, 0.9
    samples = stats.gumbel_r.rvs(location, scale, size=(tries, count), random_state=np.random.default_rng(7))
    fits = [fit_gumbel(sample).at(k, confidence) for sample in samples]
    right = np.mean([each.low < location + k * scale < each.high for each in fits])
    assert right == pytest.approx(confidence, abs=3.0 * np.sqrt(confidence * (1.0 - confidence) / tries))


def test_intervals_of_weibulls_fit_are_right_as_often_as_they_say() -> None:
    shape, scale, tries, confidence, peaks = 1.5, 4.0, 300, 0.9, 1000.0
    samples = stats.weibull_min.rvs(shape, 0.0, scale, size=(tries, 60), random_state=np.random.default_rng(8))
    largest = scale * np.log(peaks) ** (1.0 / shape)
    fits = [fit_weibull(sample).largest(peaks, confidence) for sample in samples]
    right = np.mean([each.low < largest < each.high for each in fits])
    assert right == pytest.approx(confidence, abs=3.0 * np.sqrt(confidence * (1.0 - confidence) / tries))


def test_weibulls_fit_is_that_of_most_likelihood() -> None:
    heights = stats.weibull_min.rvs(1.7, 0.0, 5.0, size=200, random_state=np.random.default_rng(9))
    shape, _, scale = stats.weibull_min.fit(heights, floc=0.0)
    assert fit_weibull(heights).shape == pytest.approx(shape, rel=1e-3)
    assert fit_weibull(heights).scale == pytest.approx(scale, rel=1e-3)
    exceeded = stats.weibull_min.sf(4.0, shape, 0.0, scale)
    assert fit_weibull(heights).exceedance(np.array(4.0)) == pytest.approx(exceeded, rel=1e-2)


def test_each_of_n_samples_is_exceeded_as_often_as_its_rank_in_one_more() -> None:
    samples, exceeded = plotting_positions(np.array([1.0, 3.0, 2.0]))
    assert (samples.tolist(), exceeded.tolist()) == ([3.0, 2.0, 1.0], [0.25, 0.5, 0.75])


def test_what_is_exceeded() -> None:
    result = analysed(gaussian(10), block=2000.0)
    assert result.exceeded(1.0)["time"] == pytest.approx(stats.norm.sf(1.0), rel=0.05)
    at_most_probable = result.exceeded(result.rayleigh)["rayleigh"]
    assert at_most_probable == pytest.approx(1.0 - np.exp(-1.0))  # once in the time foretold, on average
    assert result.exceeded(result.gumbel.value)["gumbel"] == pytest.approx(1.0 - np.exp(-1.0))
    assert result.exceeded(result.weibull.value)["weibull"] == pytest.approx(1.0 - np.exp(-1.0))


def test_minima_are_maxima_of_the_mirror_image() -> None:
    x = gaussian(11, 2**14) + 0.1 * gaussian(12, 2**14) ** 2
    least, most = analysed(x, minima=True, block=200.0), analysed(-x, block=200.0)
    assert least.rayleigh == pytest.approx(-most.rayleigh)
    assert least.weibull == pytest.approx((-most.weibull.value, -most.weibull.high, -most.weibull.low))
    assert least.gumbel == pytest.approx((-most.gumbel.value, -most.gumbel.high, -most.gumbel.low))
    assert least.exceeded(-2.0) == pytest.approx(most.exceeded(2.0))
    assert least.period == pytest.approx(most.period)


def run_of(folder: Path, tension: Array, time: Array | None = None) -> Path:
    """A run of a static and a dynamic stage, its effective tension 1, 2 and 3 times as large at the three nodes."""
    t = STEP * np.arange(1, len(tension) + 1) if time is None else time
    folder.mkdir()
    at = np.concatenate([[0.0], tension])
    with h5py.File(folder / "results.nc", "w") as file:
        file.update({"arc": [0.0, 10.0, 20.0], "time": np.append(0.0, t), "stage": np.minimum(np.arange(len(at)), 1)})
        file.update({"effective_tension": at[:, None] * [1.0, 2.0, 3.0], "end_force": at[:, None] * [3.0, 0.0, 4.0]})
    stages = [{"name": "lay", "kind": "static", "time": 0.0}, {"name": "storm", "kind": "dynamic", "time": t[-1]}]
    (folder / "summary.json").write_text(json.dumps({"stages": stages}), encoding="utf-8")
    return folder


def test_records_of_places_and_components(tmp_path: Path) -> None:
    x = np.arange(40.0)
    run = Run(run_of(tmp_path / "run", x))
    between = records_of([run], "effective_tension", [5.0, 20.0])
    assert between.values[0] == pytest.approx(x[:, None] * [1.5, 3.0])
    assert between.units == "N"
    assert between.step == pytest.approx(STEP)
    assert records_of([run], "effective_tension", None).arc.tolist() == [0.0, 10.0, 20.0]
    assert records_of([run], "end_force.z", None).values[0][:, 0] == pytest.approx(4.0 * x)
    assert records_of([run], "end_force.size", [5.0]).values[0][:, 0] == pytest.approx(5.0 * x)


def test_histories_are_columns_beside_time(tmp_path: Path) -> None:
    """Names without blanks or commas; time from the stage's beginning, the transient cut off."""
    run, file = run_of(tmp_path / "run", np.arange(40.0)), tmp_path / "x.csv"
    words = [str(run), "--of", "effective_tension", "--at", "end", "--arc", "5", "--of", "end_force.x"]
    words += ["--since", "2.5"]
    done = CliRunner().invoke(app, ["histories", *words, "-o", str(file)])
    assert done.exit_code == 0, done.output
    head, *rows = list(csv.reader(file.open()))
    assert head == ["time_s", "effective_tension_at_5m_N", "effective_tension_at_20m_N", "end_force.x_N"]
    columns = np.array(rows, dtype=float)
    n = columns[:, 0] / STEP - 1.0
    assert columns[0, 0] == pytest.approx(2.5)
    assert columns[:, 1:] == pytest.approx(n[:, None] * [1.5, 3.0, 3.0])
    assert CliRunner().invoke(app, ["histories", *words]).output == file.read_text()


def test_what_does_not_vary_has_no_extremes(tmp_path: Path) -> None:
    file, run = tmp_path / "still.json", run_of(tmp_path / "run", np.full(40, 7.0))
    asked = "--of", "end_force.y", "--above", "1", "-o", str(file), "--plot", str(tmp_path / "still.png")
    done = called(str(run), *asked)
    assert done.exit_code == 0, done.output
    assert done.output.splitlines()[-1].split()[1:] == ["N", "1", "0", "-", "-", "-"]
    (still,) = json.loads(file.read_text())
    assert still["spectrum"]["period_sqrt_m0_over_m2_s"] is None
    assert still["rayleigh"] is None


def test_transient_is_cut_off(tmp_path: Path) -> None:
    run = Run(run_of(tmp_path / "run", np.arange(40.0)))
    assert records_of([run], "end_force.x", None, since=2.5).values[0][0, 0] == pytest.approx(3.0 * 9.0)


def test_uneven_records_are_evened(tmp_path: Path) -> None:
    t = np.cumsum(np.where(np.arange(60) % 2, 0.2, 0.3))
    records = records_of([Run(run_of(tmp_path / "run", 7.0 * t, t))], "effective_tension", [0.0])
    assert records.step == pytest.approx(0.2)
    assert np.diff(records.values[0][:, 0]) == pytest.approx(np.full(73, 7.0 * records.step))


def test_even_records_stay_what_they_are_beside_an_odd_last_one(tmp_path: Path) -> None:
    """The end of a stage is recorded, too, though it is no multiple of the interval."""
    t = np.append(STEP * np.arange(1, 401), 400.3 * STEP)
    x = np.sin(2.0 * np.pi * t / PERIOD)
    records = records_of([Run(run_of(tmp_path / "run", x, t))], "effective_tension", [0.0])
    assert records.values[0][:, 0] == pytest.approx(x[:-1], abs=1e-9)


def test_too_few_values_at_the_step_of_another_run(tmp_path: Path) -> None:
    fine = run_of(tmp_path / "fine", np.zeros(40))
    coarse = run_of(tmp_path / "coarse", np.zeros(40), 10.0 * STEP * np.arange(1, 41))
    with pytest.raises(ResultsError, match=telling("fine:", "4 values", "2.5 s", "fewer than 20")):
        records_of([Run(fine), Run(coarse)], "effective_tension", None)


def test_runs_of_unlike_steps_get_the_longest(tmp_path: Path) -> None:
    folders = run_of(tmp_path / "a", np.zeros(80)), run_of(tmp_path / "b", np.zeros(40), 2.0 * STEP * np.arange(1, 41))
    records = records_of([Run(folder) for folder in folders], "effective_tension", None)
    assert records.step == pytest.approx(2.0 * STEP)
    assert [len(values) for values in records.values] == [40, 40]


@pytest.mark.parametrize(
    ("name", "arcs", "more", "message"),
    [
        ("tension", None, {}, "--of tension: is none of the outputs in time; they are position, effective_tension"),
        ("end_force", None, {}, "--of end_force: end_force is a vector; write end_force.x, .y, .z or .size"),
        ("effective_tension.x", None, {}, "--of effective_tension.x: effective_tension is a number; write effective_t"),
        ("effective_tension", [21.0], {}, "--arc 21: is not on the riser of RUN, which is 20 m long"),
        ("effective_tension", None, {"since": 6.0}, 'RUN: stage "storm" has 17 records from 6 s on, fewer than 20;'),
        ("effective_tension", None, {"stage": "lay"}, 'RUN: "lay" is no dynamic stage of the run; its dynamic stages:'),
    ],
)
def test_what_is_refused(tmp_path: Path, name: str, arcs: Any, more: Any, message: str) -> None:
    folder = run_of(tmp_path / "run", np.arange(40.0))
    with pytest.raises(ResultsError) as refused:
        records_of([Run(folder)], name, arcs, **more)
    assert str(refused.value).replace(str(folder), "RUN").startswith(message)


@pytest.fixture(scope="module")
def seeds(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    place = tmp_path_factory.mktemp("seeds")
    return [str(run_of(place / f"seed{n}", 1.0e4 * (10.0 + gaussian(20 + n, 2**12)))) for n in range(4)]


def called(*words: str) -> Any:
    return CliRunner().invoke(app, ["statistics", *words])


def test_command_leaves_table_numbers_and_picture(seeds: list[str], tmp_path: Path) -> None:
    file, png = tmp_path / "statistics.csv", tmp_path / "statistics.png"
    asked = ("--of", "effective_tension", "--at", "end", "--of", "end_force.x", "--since", "50", "--above", "3.5e5")
    done = called(*seeds, *asked, "-o", str(file), "--plot", str(png))
    assert done.exit_code == 0, done.output
    rows = list(csv.DictReader(file.open()))
    assert [(row["output"], row["arc_m"], row["unit"]) for row in rows] == [
        ("effective_tension", "20", "N"),
        ("end_force.x", "", "N"),
    ]
    assert float(rows[0]["mean"]) == pytest.approx(3.0e5, rel=0.02)
    assert float(rows[0]["gumbel_low"]) < float(rows[0]["gumbel"]) < float(rows[0]["gumbel_high"])
    assert float(rows[0]["time_beyond_350000"]) == pytest.approx(stats.norm.sf(5.0 / 3.0), rel=0.3)
    assert "effective_tension at 20 m" in done.output
    assert "end_force.x" in done.output
    assert png.read_bytes().startswith(b"\x89PNG")


def test_command_tells_all_nodes_and_writes_json(seeds: list[str], tmp_path: Path) -> None:
    file = tmp_path / "statistics.json"
    done = called(seeds[0], "--of", "effective_tension", "-o", str(file), "--minima")
    assert done.exit_code == 0, done.output
    places = json.loads(file.read_text())
    assert [place["arc_m"] for place in places] == [0.0, 10.0, 20.0]
    assert places[0]["gumbel"] is None
    assert len(places[0]["spectrum"]["frequency_Hz"]) == len(places[0]["spectrum"]["density_N2_per_Hz"])
    line_with(done.output, "Gumbel's distribution", "three maxima")


def test_too_coarse_records_are_warned_of(tmp_path: Path) -> None:
    t = np.arange(1, 400) * 1.0
    folder = run_of(tmp_path / "run", np.sin(2.0 * np.pi * t / PERIOD), t)
    done = called(str(folder), "--of", "end_force.x")
    warning = "warning: there are only 8 records in a zero-crossing period, so that peaks may be missed by 7.6 %"
    assert warning in done.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--of", "end_force.x", "--at", "top"), "--at top: must be start or end; other places are given by --arc"),
        (("--of", "end_force.x", "--confidence", "95"), "--confidence 95: must lie between 0 and 1"),
        (("--of", "end_force.x", "--duration", "0"), "--duration 0: must be greater than 0"),
        (("--of", "end_force.x", "-o", "x.txt"), "x.txt: statistics go to a .csv or .json file; change its ending"),
        (("--of", "end_force.x", "--plot", "x.pdf"), "x.pdf: a picture is a .png file; change its ending"),
    ],
)
def test_wrong_calls(seeds: list[str], words: tuple[str, ...], message: str) -> None:
    done = called(seeds[0], *words)
    assert done.exit_code == 2
    assert done.output == f"{message}\n"


def test_no_table_is_left_where_the_picture_is_refused(seeds: list[str], tmp_path: Path) -> None:
    table = tmp_path / "x.csv"
    done = called(seeds[0], "--of", "end_force.x", "-o", str(table), "--plot", str(tmp_path / "x.pdf"))
    assert done.exit_code == 2
    assert not table.exists()
