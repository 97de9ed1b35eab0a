# Every goal starts from a bare Debian: `make demo` and `make test` set up what they need (scripts/setup.sh).

PYTHON := .venv/bin/python
WORKERS ?= $(shell env -u OMP_NUM_THREADS nproc)
DECKS ?= build/decks
SUITES ?= bookworm trixie
DOCKER ?= docker

export OMP_NUM_THREADS := 1
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
# More ranks than cores, and free to move between them, in the words of OpenMPI 4 and of OpenMPI 5.
export OMPI_MCA_rmaps_base_oversubscribe := 1
export OMPI_MCA_hwloc_base_binding_policy := none
export PRTE_MCA_rmaps_default_mapping_policy := :oversubscribe
export PRTE_MCA_hwloc_default_binding_policy := none
# OpenMPI 5 complains of network interfaces, which ranks of one machine don't use.
export OMPI_MCA_btl := ^tcp
export MPLBACKEND := Agg
export PYVISTA_OFF_SCREEN := true
export VTK_DEFAULT_OPENGL_WINDOW := vtkEGLRenderWindow

.PHONY: help environment setup demo demos test quick lint coverage verify stress around fuzz mutants bench bench-peers bench-decks parts bars asked precision quality figures verify-fresh docs dist docker pins clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 16

environment: # Debian packages, the environment .venv, riser_soil in it; does nothing when they are there
	@scripts/setup.sh

setup: environment ## Debian packages, the environment .venv, riser_soil in it, and kernels compiled, so that first runs start at once
	@scripts/compile.sh

demo: environment ## a flexible riser comes down on a block of soft clay in 3D: results and a picture in demos/touchdown_clay/results
	$(PYTHON) -m demos.touchdown_clay.run

demos: demo ## that demo and the others (demos/*/README.md), with their tables and pictures
	$(PYTHON) -m demos.grounds.run
	$(PYTHON) -m demos.catenary.run
	$(PYTHON) -m demos.tank.run
	$(PYTHON) -m demos.waves.run
	$(PYTHON) -m demos.offsets.run
	$(PYTHON) -m demos.pipe_segment.run
	$(PYTHON) -m demos.trench.run
	$(PYTHON) -m demos.lines.run
	$(PYTHON) -m demos.client_report.run

test: environment ## linters, types, and the quick tests, some of them on two ranks
	@$(MAKE) --no-print-directory -j2 lint quick # types are checked beside the tests, which leave cores now and then

quick: environment
	$(PYTHON) -m pytest -n $(WORKERS) --dist loadfile --no-loadscope-reorder

lint: environment
	$(PYTHON) -m ruff check .
	$(PYTHON) -m mypy

coverage: environment ## share of the lines that are not compiled which the quick tests reach: at least 90 %, build/coverage/html
	@rm -rf build/coverage && mkdir -p build/coverage
	$(PYTHON) -m coverage run -m pytest -n $(WORKERS) --dist loadfile --no-loadscope-reorder
	$(PYTHON) -m coverage combine --quiet && $(PYTHON) -m coverage html --quiet && $(PYTHON) -m coverage report

verify: environment ## the long comparisons with closed forms, references and finer meshes
	$(PYTHON) -m pytest -m verify

stress: environment ## stiff and extreme scenes with known answers, each in a process with limits: docs/stress.md; also among those of verify
	$(PYTHON) -m tests.robustness.stress.run --page

around: environment ## extremes of a scene, SCENE=file.yaml, each in a process with limits: which end quietly wrong
	$(PYTHON) -m tests.robustness.stress.around $(SCENE)

fuzz: environment ## 600 mutated scenes, each in a process with limits: how they end; also among those of verify
	$(PYTHON) -m tests.robustness.fuzz.run --count 600 --seed 1

mutants: environment ## some 70 places of the package broken one at a time: which of them the quick tests notice; takes long
	$(PYTHON) -m tests.robustness.mutants.run

bench: environment ## what steps of lines, soils, waves and storms cost: docs/speed.md; Newton iterations against the bare work in them, energy of an impact by scheme
	$(PYTHON) -m benchmarks --page
	$(PYTHON) -m benchmarks.large --page

bench-peers: environment ## what the same answers cost by CableDyn, Exudyn, MoorDyn and CalculiX: docs/peers.md; takes long
	@scripts/peers.sh
	$(PYTHON) -m benchmarks.peers --page
	$(PYTHON) -m benchmarks.peers.clay --page
	$(PYTHON) -m benchmarks.peers.shaken --page
	$(PYTHON) -m benchmarks.peers.hung --page

bench-decks: environment ## what becomes of decks of public repositories, cloned into DECKS: docs/decks.md; takes long
	@scripts/peers.sh
	$(PYTHON) -m benchmarks.decks $(DECKS) --workers $(WORKERS) --page

parts: environment ## what each part of a scene costs: docs/parts.md
	$(PYTHON) -m benchmarks.parts --page

bars: environment ## error bars of 211 scenes beside their true errors: docs/error_bars.md
	$(PYTHON) -m benchmarks.error_bars

asked: environment ## scenes that ask for 1 %, whether they reach it and what it costs beside the best by hand: docs/asked_accuracy.md
	$(PYTHON) -m benchmarks.asked_accuracy

precision: environment ## error of soil's results against processor time, by method: docs/soil_precision.md; takes long
	$(PYTHON) -m benchmarks.soil_precision

quality: stress bars asked parts ## those four and a study of the first scene: docs/quality.md
	$(PYTHON) -m benchmarks.quality

verify-fresh: ## both commands of the README on bare Debians 12 and 13 made for it (needs root and debootstrap)
	@set -e; for suite in $(SUITES); do FRESH_SUITE=$$suite scripts/verify_fresh.sh; done

docs: environment ## a site of all pages, with search: build/site
	@scripts/site.sh

figures: environment ## the figures that README, tutorials and the pages of two demos tell, from runs of their scenes
	rm -rf build/figures
	$(PYTHON) -m demos.figures --page
	$(PYTHON) -m demos.offsets.run --page
	$(PYTHON) -m demos.touchdown_clay.run --page
	$(PYTHON) -m demos.grounds.run --page

dist: environment ## wheel and source distribution, checked: build/dist
	$(PYTHON) scripts/dist.py

docker: ## the image riser_soil, on Debian 12 or on BASE=debian:trixie
	$(DOCKER) build$(if $(BASE), --build-arg BASE=$(BASE)) -t riser_soil -f docker/Dockerfile .

pins: ## the versions of requirements/*-pins.txt resolved anew for requirements/run.txt and dev.txt
	@scripts/pin.sh

clean: ## what set-up, tests and runs have left here
	rm -rf .venv build results demos/*/results .pytest_cache .mypy_cache .ruff_cache .hypothesis riser_soil.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
