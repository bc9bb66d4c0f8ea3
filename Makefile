# SPDX-License-Identifier: BSD-3-Clause
# What builds, tests and measures, and what ./soslam does, for scripts: `make run DATASET=room_a` is `./soslam run room_a`.
# Values are plain names here; ./soslam takes any text.

DATASET ?=
VARIANT ?= all
STAGE ?=
DATA_ROOT ?= data
RESULTS ?= results
PIPELINES ?= pipelines
THREADS ?= 0
BUILD ?= build
CMAKE_ARGS ?=
OUTSIDE_PATHS ?=
LAUNCH ?=
DATASETS ?=
SCENES ?=
SEEDS ?= 1
SBATCH ?=
DOWNLOADS ?= pipelines/downloads.tsv
ANNOTATIONS ?= data/annotations
NETWORKS ?= networks
WITHOUT ?=
MIRROR ?=
MAPS ?= maps
IMAGES ?=
NETWORK ?=
PHOTOS ?=
BIN := $(BUILD)/bin

# Some shells set NAME to that of the machine: only `make ... NAME=<map>` counts.
ifneq ($(origin NAME),command line)
override NAME :=
endif

MAKEFLAGS += --no-print-directory
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

# What ./soslam is told.
TOLD := DATASET VARIANT STAGE $(if $(filter file,$(origin DATA_ROOT)),,DATA_ROOT) RESULTS PIPELINES THREADS BUILD BIN \
  OUTSIDE_PATHS LAUNCH DOWNLOADS ANNOTATIONS NETWORKS WITHOUT MIRROR MAPS IMAGES NETWORK DETECTIONS CAMERA MODEL EDITS \
  TRUTH SCALE CAMERA_HEIGHT NAME
SOSLAM = SETTINGS_OF_MAKE=yes $(foreach name,$(TOLD),$(name)='$(subst ','\'',$(value $(name)))') JOBS= MAKE='$(MAKE)' ./soslam

# What make itself uses; ./soslam checks what it is told.
$(foreach name,RESULTS BUILD DATA_ROOT PIPELINES,$(if $(filter-out 1,$(words $(value $(name)))), \
  $(error $(name)='$(value $(name))': expected one folder without spaces in its path)))

# A variable that is misspelt would be ignored without a word. A make above this one has variables of its own.
ifeq ($(MAKELEVEL),0)
given-names = $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
KNOWN := $(TOLD) DATA_ROOT CMAKE_ARGS DATASETS SCENES SEEDS SBATCH PHOTOS QUIET CC CXX SHELL %FLAGS CMAKE_% SOSLAM_% \
  MAKE% CTEST_% GTEST_% VERBOSE %_proxy TMPDIR DEBIAN_FRONTEND
$(foreach name,$(filter-out $(KNOWN) -%,$(given-names)), \
  $(error $(name)=...: no variable of this Makefile has this name))
endif

COMMANDS := clean map data network doctor export explain check-minima status report tables results-page verify reproduce \
  train-head
.PHONY: $(COMMANDS) help demo run run-built plan ablation scenes sweep submit setup build test test-slow test-build \
  test-slurm check-photos bench formatter format format-check clean distclean

help: ## List the targets
	@echo 'make <target> [NAME=value ...]; ./soslam help says what values there are: --data_root is DATA_ROOT'
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 16 | sed 's/^/  /'
	@echo 'OUTSIDE_PATHS=--allow_outside_paths (images may lie outside their dataset: see docs/datasets.md)'
	@echo 'Sweeps (see docs/sweeps.md): DATASETS="<name> <name>", SCENES="<scene file> ...", SEEDS="1 2 3" of the'
	@echo 'noise in scenes, SBATCH="<arguments of sbatch>", LAUNCH=<command that starts each stage, as srun>'
	@cd $(PIPELINES)/variants && echo Variants: *.json | sed 's/\.json//g'

demo: ## Run all variants on the sequence that comes with the project, print the tables, make pages
	@$(MAKE) run DATASET=room_a DATA_ROOT=data VARIANT=all
	@$(MAKE) report
	@echo
	@echo 'These tables: $(RESULTS)/tables.md. Pages: $(RESULTS)/report.html, opens in a browser. Every'
	@echo 'intermediate result: $(RESULTS)/room_a/<variant>/'

run: ## Run DATASET=<name> through VARIANT=<name>|all; only what is out of date, past what fails; -j1: one stage at a time
run run-built plan:
	+@$(SOSLAM) $@

clean: ## Delete what runs wrote to RESULTS
map: ## Make a map of IMAGES=<folder of photos, or a video> with NETWORK=<file.onnx>; see docs/photos-to-map.md
data: ## Fetch DATASET=<name> from its publishers, check it, lay our annotation over it: DATA_ROOT/<name>
network: ## Fetch the detector network YOLOX-nano, check it and show its licence: NETWORKS/yolox_nano
doctor: ## Say what import and all stages that ran for DATASET=<name> found: errors, warnings, remedies
export: ## Write the maps of DATASET=<name>, VARIANT=<name>|all in formats of other programs
explain: ## Say why STAGE=<name> of DATASET=<name> and VARIANT=<name>|all would run again
check-minima: ## Solve each object of the maps of DATASET=<name>, VARIANT=<name>|all, alone from other yaws and sizes
status: ## Say for each dataset, variant and stage: done, stale, failed, missing, queued or running
report: ## Make pages to look at: RESULTS/report.html, and one in the folder of each dataset; and the tables
tables: ## Compare all variants of all datasets in RESULTS: tables.md, tables/*.csv, tables/*.tex
results-page: ## Renew the tables of docs/results.md from RESULTS, with what make tables makes
verify: ## Say which files in RESULTS, or that they were made from, are no longer what was recorded
reproduce: ## Run what made the variants in RESULTS once more, as recorded, and compare every byte
train-head: ## Train the head that tells which way furniture faces, for NETWORK=<file.onnx>; see docs/appearance.md
$(COMMANDS):
	$(if $(findstring n,$(firstword -$(MAKEFLAGS))),,+)@$(SOSLAM) $@

ablation: ## Run DATASET=<name> through the ablations of docs/shapes.md, into RESULTS/ablation
	+@$(MAKE) run PIPELINES=pipelines/ablation RESULTS=$(RESULTS)/ablation

# A sweep: datasets, and each scene rendered with each seed of its noise, as dataset <scene>-seed<seed> in DATA_ROOT.
scene-name = $(basename $(notdir $(1)))
SEEDED = $(foreach scene,$(SCENES),$(SEEDS:%=$(call scene-name,$(scene))-seed%))
in-data-root = $(if $(filter $(abspath $(DATA_ROOT)),$(abspath $(dir $(1)))),$(notdir $(1)), \
  $(error dataset '$(1)': expected a folder in DATA_ROOT = $(DATA_ROOT)))
SWEEP = $(foreach name,$(DATASETS:%/=%),$(if $(findstring /,$(name)),$(call in-data-root,$(name)),$(name))) $(SEEDED)
ifneq ($(filter-out $(COMMANDS) run run-built plan,$(if $(NAME),$(MAKECMDGOALS))),)
$(error make $(MAKECMDGOALS) takes no NAME)
endif
ifneq ($(filter sweep submit,$(MAKECMDGOALS)),)
$(if $(DATASETS)$(SCENES),,$(error expected DATASETS='<name> ...', SCENES='<file> ...' or both))
$(if $(filter-out $(words $(sort $(SEEDED))),$(words $(SEEDED))),$(error SCENES or SEEDS='$(SEEDS)' has a name twice))
endif
# Stages that run side by side must not mix their lines; synchronised, progress would come too late.
SIDE_BY_SIDE = $(if $(filter-out -j1,$(filter -j% --jobserver%,$(MAKEFLAGS))),--output-sync QUIET=--quiet)

# Rendered once, and again when the scene changes.
define scene-rule
$(DATA_ROOT)/$(call scene-name,$(1))-seed%/run.json: $(1) | $(BIN)/soslam-synthesise
	@echo '[$$(notdir $$(@D))] synthesise'
	@$$(LAUNCH) $(BIN)/soslam-synthesise --scene $(1) --seed $$* --output $$(@D) --threads $(THREADS) $$(QUIET)
endef
$(foreach scene,$(SCENES),$(eval $(call scene-rule,$(scene))))
$(foreach name,$(SEEDED),$(eval swept/$(name): $(DATA_ROOT)/$(name)/run.json))

scenes: $(SEEDED:%=$(DATA_ROOT)/%/run.json)

sweep: build ## Run DATASETS and SCENES with SEEDS through VARIANT=<name>|all; with -j, side by side
	+@$(MAKE) --keep-going $(SIDE_BY_SIDE) $(SWEEP:%=swept/%)

.PHONY: $(SWEEP:%=swept/%)
$(SWEEP:%=swept/%):
	+@$(MAKE) run-built DATASET=$(@F)

submit: build ## Queue with Slurm what `make sweep` would run; `make status` then shows it
	+@$(MAKE) --keep-going $(SIDE_BY_SIDE) scenes
	@mkdir -p $(RESULTS)
	$(if $(findstring n,$(firstword -$(MAKEFLAGS))),,+)@pipelines/slurm/submit $(RESULTS) $(BIN) '$(SWEEP)' $(SBATCH)

setup: ## Install the packages that are missing (apt, as root or through sudo)
	@pipelines/install-packages.sh build

build: $(BUILD)/build.ninja ## Build the executables of the stages
	@pipelines/build.sh $(BUILD) $(patsubst stages/%.cpp,soslam-%,$(wildcard stages/*.cpp))

$(BUILD)/build.ninja: | setup
	@mkdir -p $(BUILD) && test -w $(BUILD) || { \
	  echo 'build: $(BUILD) cannot be written to; expected BUILD=<a folder of your own>' >&2; exit 2; }
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON $(CMAKE_ARGS)

test: test-build ## Build everything and run the fast tests (3 minutes)
	@ctest --test-dir $(BUILD) --output-on-failure --label-regex fast -j2

test-slow: test-build ## Run the slow tests: faults, browsers, videos, clusters, statistics
	@pipelines/install-packages.sh test || echo 'setup: tests that need a browser or ffmpeg are skipped'
	@ctest --test-dir $(BUILD) --output-on-failure --label-regex slow -j2

test-build: $(BUILD)/build.ninja
	@pipelines/install-packages.sh data || echo 'setup: tests of downloads are skipped'
	@pipelines/build.sh $(BUILD)

test-slurm: build ## Install Slurm, and run the tests of sweeps on a cluster of two nodes on this machine
	@pipelines/install-packages.sh slurm
	@pipelines/build.sh $(BUILD) slurm_test
	@SOSLAM_SLURM=required ctest --test-dir $(BUILD) --output-on-failure --tests-regex '^slurm'

check-photos: ## Make maps of annotated photos in DATA_ROOT, PHOTOS=<names>, with NETWORK=<file.onnx>; see tests/photos
	@tests/photos/check --data_root '$(DATA_ROOT)' --network '$(NETWORK)' --maps '$(MAPS)' --results '$(RESULTS)' \
	  --build '$(BUILD)' --photos '$(PHOTOS)'

# Five repetitions, each of a tenth of a second or more: the table has their medians.
bench: $(BUILD)/build.ninja ## Measure how long things take, beside the paper's method: RESULTS/bench.md, bench.json
	@pipelines/install-packages.sh bench
	@flock $(BUILD) cmake $(BUILD) > /dev/null
	@pipelines/build.sh $(BUILD) soslam-bench soslam-bench-table
	@mkdir -p $(RESULTS)
	@$(BIN)/soslam-bench --benchmark_repetitions=5 --benchmark_min_time=0.1 \
	  --benchmark_report_aggregates_only=true --benchmark_out_format=json --benchmark_out=$(RESULTS)/.bench.json.tmp
	@$(BIN)/soslam-bench-table $(RESULTS)/.bench.json.tmp pipelines/published.json > $(RESULTS)/.bench.md.tmp
	@mv $(RESULTS)/.bench.json.tmp $(RESULTS)/bench.json
	@mv $(RESULTS)/.bench.md.tmp $(RESULTS)/bench.md
	@cat $(RESULTS)/bench.md

SOURCES = $(shell find lib stages tests -name '*.h' -o -name '*.cpp')

formatter:
	@pipelines/install-packages.sh format

format: formatter ## Format the sources
	@clang-format-14 -i $(SOURCES)

format-check: formatter ## Fail when a source is not formatted
	@clang-format-14 --dry-run -Werror $(SOURCES)

distclean: clean ## Delete the build as well
	@rm -rf $(BUILD)
