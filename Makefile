# SPDX-License-Identifier: BSD-3-Clause
# The front door. `make help` lists what it can do. What runs for a dataset is worked out by
# soslam-plan from the settings in pipelines/.

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
DETECTIONS ?=
CAMERA ?=
MODEL ?=
SCALE ?=
CAMERA_HEIGHT ?=

# Some shells set NAME to that of the machine: only `make ... NAME=<map>` counts.
ifneq ($(origin NAME),command line)
override NAME :=
endif

MAKEFLAGS += --no-print-directory
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

# Make splits names at spaces, and it, the shell and the plan of a run give other characters a meaning, so whatever has
# one of them is refused, before anything expands it: hence $(value ...). CMAKE_ARGS, LAUNCH and SBATCH are shell text.
comma := ,
hash := \#
opening := (
closing := )
SPECIAL := ! " $(hash) $$ % & ' $(opening) $(closing) * $(comma) : ; < = > ? [ \ ] ^ ` { | }
special-in = $(strip $(foreach character,$(SPECIAL),$(findstring $(character),$(value $(1)))))
refuse-special = $(if $(call special-in,$(1)),$(error $(1)='$(value $(1))': expected no $(call special-in,$(1)) in it))
refuse-options = $(if $(filter -%,$(value $(1))),$(error $(1)='$(value $(1))': expected no name that begins with -))
one-word = $(if $(filter-out 1,$(words $(value $(1)))),$(error $(1)='$(value $(1))': expected $(2)))
ONE_FOLDER = one folder without spaces in its path (a symbolic link to it will do)
NAMES := DATASET VARIANT STAGE DATA_ROOT RESULTS PIPELINES THREADS BUILD DATASETS SCENES SEEDS
NAMES += DOWNLOADS ANNOTATIONS NETWORKS WITHOUT MAPS NAME
NUMBERS := SCALE CAMERA_HEIGHT
PATHS := IMAGES NETWORK DETECTIONS CAMERA MODEL
OTHERS := CMAKE_ARGS OUTSIDE_PATHS LAUNCH SBATCH MIRROR BIN GOAL QUIET
$(foreach name,$(NAMES),$(call refuse-special,$(name))$(call refuse-options,$(name)))
refuse-comma = $(if $(findstring $(comma),$(value $(1))),$(error $(1)='$(value $(1))': expected a decimal point))
$(foreach name,$(NUMBERS),$(call refuse-comma,$(name))$(call refuse-special,$(name)))
$(foreach name,DATA_ROOT RESULTS PIPELINES BUILD ANNOTATIONS NETWORKS MAPS,$(call one-word,$(name),$(ONE_FOLDER)))
$(call one-word,DOWNLOADS,one file without spaces in its path)
$(if $(filter-out :,$(call special-in,MIRROR)),$(error MIRROR='$(value MIRROR)': expected an address))
$(if $(filter-out --allow_outside_paths,$(value OUTSIDE_PATHS)),$(error OUTSIDE_PATHS: expected --allow_outside_paths))

# A variable that is misspelt would be ignored without a word. A make above this one has variables of its own.
ifeq ($(MAKELEVEL),0)
given-names = $(foreach name,$(.VARIABLES),$(if $(filter command,$(origin $(name))),$(name)))
KNOWN := $(NAMES) $(NUMBERS) $(PATHS) $(OTHERS) CC CXX SHELL %FLAGS CMAKE_% SOSLAM_% MAKE% CTEST_% GTEST_% VERBOSE \
  %_proxy TMPDIR DEBIAN_FRONTEND
$(foreach name,$(filter-out $(KNOWN) -%,$(given-names)), \
  $(error $(name)=...: no variable of this Makefile has this name))
endif

BIN := $(BUILD)/bin
$(call refuse-special,BIN)$(call one-word,BIN,$(ONE_FOLDER))
STAGES := $(patsubst stages/%.cpp,soslam-%,$(wildcard stages/*.cpp))
SOURCES = $(shell find lib stages tests -name '*.h' -o -name '*.cpp')
PLAN = $(RESULTS)/$(DATASET)/plan.mk
PLAN_COMMAND = $(BIN)/soslam-plan --dataset $(DATA_ROOT)/$(DATASET) --name $(DATASET) \
  --pipelines $(PIPELINES) --results $(RESULTS) --variants '$(filter-out all,$(VARIANT))'
STATUS_COMMAND = pipelines/under-way $(RESULTS) | $(BIN)/soslam-status --results $(RESULTS) --executables $(BIN) \
  --under_way /dev/stdin --name '$(DATASET)' --variants '$(filter-out all,$(VARIANT))'

# The name of a map of photos stands for the dataset and the folders of that map: make doctor NAME=room.
MAP_GOALS := run run-built locked-run locked-plan doctor report tables export status explain verify reproduce clean
ifneq ($(NAME),)
$(call one-word,NAME,one name of letters and digits)
$(if $(findstring /,$(NAME))$(filter .%,$(NAME)),$(error NAME: found '$(NAME)'; expected letters and digits, _ and -))
$(foreach goal,$(filter-out map build setup help $(MAP_GOALS),$(MAKECMDGOALS)),$(error make $(goal) takes no NAME))
ifeq ($(filter map,$(MAKECMDGOALS)),)
$(if $(wildcard $(MAPS)/$(NAME)/pipelines),,$(error NAME='$(NAME)': no such map in MAPS = $(MAPS)))
$(foreach name,DATASET DATA_ROOT RESULTS PIPELINES,$(if $(filter command,$(origin $(name))), \
  $(error NAME stands for the map's own $(name); expected one of them)))
override DATASET := $(NAME)
override DATA_ROOT := $(MAPS)/$(NAME)/data
override RESULTS := $(MAPS)/$(NAME)/results
override PIPELINES := $(MAPS)/$(NAME)/pipelines
endif
endif
# Other settings would make a map anew, as of another dataset.
ifneq ($(and $(wildcard $(RESULTS)/../steps/images.txt),$(filter run run-built doctor,$(MAKECMDGOALS))),)
$(if $(filter-out $(abspath $(RESULTS)/../pipelines),$(abspath $(PIPELINES))),$(error \
  RESULTS=$(RESULTS) is of a map of photos, whose settings are not those in PIPELINES=$(PIPELINES); \
  expected NAME=$(notdir $(abspath $(RESULTS)/..)) \
  MAPS=$(patsubst %/,%,$(dir $(abspath $(RESULTS)/..)))))
endif

# A sweep: datasets, and each scene rendered with each seed of its noise, as dataset <scene>-seed<seed> in DATA_ROOT.
scene-name = $(basename $(notdir $(1)))
SEEDED = $(foreach scene,$(SCENES),$(SEEDS:%=$(call scene-name,$(scene))-seed%))
SWEEP = $(DATASETS) $(SEEDED)

# A dataset may also be named by its path in DATA_ROOT, as shells complete it.
dataset-name = $(call checked-name,$(1),$(if $(findstring /,$(1:/=)),$(call name-in-data-root,$(1)),$(1:/=)))
name-in-data-root = $(if $(filter $(abspath $(DATA_ROOT))/,$(dir $(abspath $(1)))),$(notdir $(abspath $(1))))
checked-name = $(if $(filter-out .%,$(2)),$(2),$(error dataset '$(1)': expected the name of one folder in \
  DATA_ROOT = $(DATA_ROOT)$(if $(findstring /,$(1:/=)), (or DATASET=$(notdir $(1:/=)) DATA_ROOT=$(dir $(1:/=))))))
ifneq ($(filter data run doctor ablation export explain,$(MAKECMDGOALS)),)
$(call one-word,DATASET,the name of one folder in DATA_ROOT = $(DATA_ROOT))
endif
override DATASET := $(foreach name,$(DATASET),$(call dataset-name,$(name)))
override DATASETS := $(foreach name,$(DATASETS),$(call dataset-name,$(name)))
# Before everything is built for a name that does not exist.
ifneq ($(filter run,$(MAKECMDGOALS)),)
$(if $(wildcard $(DATA_ROOT)/$(DATASET)/.)$(filter data scenes,$(MAKECMDGOALS)),,$(error DATASET=$(DATASET): no such folder in DATA_ROOT = $(DATA_ROOT)))
$(foreach name,$(filter-out all,$(VARIANT)),$(if $(wildcard $(PIPELINES)/variants/$(name).json),, \
  $(error VARIANT=$(name): no such variant; known are $(basename $(notdir $(wildcard $(PIPELINES)/variants/*.json))))))
endif
ifneq ($(filter sweep submit,$(MAKECMDGOALS)),)
$(if $(DATASETS)$(SCENES),,$(error expected DATASETS='<name> ...', SCENES='<file> ...' or both))
$(if $(filter-out $(words $(sort $(SEEDED))),$(words $(SEEDED))),$(error SCENES or SEEDS='$(SEEDS)' has a name twice))
endif
ifneq ($(filter explain,$(MAKECMDGOALS)),)
$(call one-word,STAGE,the name of one stage)
endif
ifneq ($(filter status explain,$(MAKECMDGOALS)),)
$(if $(wildcard $(BIN)/soslam-status),,$(error $(BIN)/soslam-status is not there yet: make build))
endif

.PHONY: help
help: ## List the targets
	@echo 'make <target> [NAME=value ...]'
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(firstword $(MAKEFILE_LIST)) | expand -t 16 | sed 's/^/  /'
	@echo 'DATASET=<folder in DATA_ROOT, or its path>, VARIANT=<name>|"<name> <name>"|all, DATA_ROOT=data,'
	@echo 'RESULTS=results, PIPELINES=pipelines, BUILD=build, THREADS=0 (threads per stage; 0 = all cores)'
	@echo 'OUTSIDE_PATHS=--allow_outside_paths (images may lie outside their dataset: see docs/datasets.md)'
	@echo 'STAGE=<name> as in the table of `make status`, LAUNCH=<command that starts each stage, as srun>'
	@echo 'Sweeps (see docs/sweeps.md): DATASETS="<name> <name>", SCENES="<scene file> ...", SEEDS="1 2 3" of the'
	@echo 'noise in scenes, SBATCH="<arguments of sbatch>"'
	@echo 'Maps of photos (see docs/photos-to-map.md): IMAGES=<folder or video>, NETWORK=<file.onnx> or'
	@echo 'DETECTIONS=<file.csv>; VARIANT=OursSP, NAME=<that of the folder or video>, MAPS=maps; where known,'
	@echo 'CAMERA=<camera.json>, MODEL=<folder of COLMAP>, SCALE=<metres per unit of MODEL>, CAMERA_HEIGHT=<metres>.'
	@echo 'NAME=<map> in place of DATASET, DATA_ROOT, RESULTS, PIPELINES: that map, to look at it or run it again'
	@echo 'Datasets of others (see docs/data.md): MIRROR=<address of copies of the downloads>, WITHOUT=<folder of the'
	@echo 'dataset that is left out>, NETWORKS=networks'
	@cd $(PIPELINES)/variants && echo Variants: *.json | sed 's/\.json//g'

.PHONY: demo
demo: ## Run all variants on the sequence that comes with the project, print the tables, make pages
	@$(MAKE) run DATASET=room_a DATA_ROOT=data VARIANT=all
	@$(MAKE) report
	@echo
	@echo 'These tables: $(RESULTS)/tables.md. Pages: $(RESULTS)/report.html, opens in a browser. Every'
	@echo 'intermediate result: $(RESULTS)/room_a/<variant>/'

FETCH = MIRROR='$(MIRROR)' WITHOUT='$(WITHOUT)' pipelines/fetch.sh $(DOWNLOADS)

.PHONY: data
data: ## Fetch DATASET=<name> from its publishers, check it, lay our annotation over it: DATA_ROOT/<name>
	@pipelines/install-packages.sh data
	@$(FETCH) $(ANNOTATIONS) $(DATA_ROOT) '$(DATASET)'

.PHONY: network
network: ## Fetch the detector network YOLOX-nano, check it and show its licence: NETWORKS/yolox_nano
	@pipelines/install-packages.sh data
	@$(FETCH) pipelines/networks $(NETWORKS) yolox_nano
	@cat $(NETWORKS)/yolox_nano/README.md

# Paths that may have any characters: the shell gets them as one quoted word, make expands them nowhere, also not on the
# way to a make below.
unexport $(PATHS)
define line-end


endef
refuse-lines = $(if $(findstring $(line-end),$(value $(1))),$(error $(1): expected a path of one line))
$(foreach name,$(PATHS) SCALE CAMERA_HEIGHT,$(call refuse-lines,$(name)))
shell-word = '$(subst ','\'',$(value $(1)))'
ifneq ($(filter map,$(MAKECMDGOALS)),)
MAKEOVERRIDES :=
MAKE_PROGRAM := $(MAKE)
override NAME := $(or $(NAME),$(shell pipelines/map-name $(call shell-word,IMAGES)))
endif

.PHONY: map
map: ## Make a map of IMAGES=<folder of photos, or a video> with NETWORK=<file.onnx>; see docs/photos-to-map.md
	@$(MAKE) build BUILD=$(BUILD) CMAKE_ARGS='$(CMAKE_ARGS)'
	$(if $(findstring n,$(firstword -$(MAKEFLAGS))),,+)@MAP_IMAGES=$(call shell-word,IMAGES) \
	  MAP_NETWORK=$(call shell-word,NETWORK) \
	  MAP_DETECTIONS=$(call shell-word,DETECTIONS) MAP_CAMERA=$(call shell-word,CAMERA) \
	  MAP_MODEL=$(call shell-word,MODEL) MAP_SCALE='$(SCALE)' \
	  MAP_CAMERA_HEIGHT='$(CAMERA_HEIGHT)' MAP_ROOT=$(MAPS)/$(NAME) MAP_NAME=$(NAME) MAP_THREADS=$(THREADS) \
	  MAP_VARIANT='$(or $(strip $(patsubst all,OursSP,$(VARIANT))),OursSP)' BIN=$(BIN) BUILD=$(BUILD) \
	  MAKE='$(MAKE_PROGRAM)' pipelines/map.sh

GIVEN_JOBS = $(filter -j% --jobserver%,$(MAKEFLAGS))
# Stages that run side by side must not mix their lines; synchronised, progress would come too late.
SEVERAL_JOBS = $(if $(filter-out -j1,$(GIVEN_JOBS)),--output-sync QUIET=--quiet)

# One run of a dataset at a time. What it started keeps the lock, so that a run that was killed does
# not write beside the next one.
LOCK = $(RESULTS)/.$(DATASET).lock

# The stages of several variants run side by side, as few of them keep all cores busy alone.
SEVERAL_VARIANTS = $(filter-out 1,$(words $(VARIANT)))$(filter all,$(VARIANT))
SIDE_BY_SIDE = $(if $(SEVERAL_VARIANTS),$(if $(GIVEN_JOBS)$(LAUNCH),,--jobs=$(shell nproc)))

.PHONY: run
run: build ## Run DATASET=<name> through VARIANT=<name>|all; only what is out of date, past what fails; -j1: one stage at a time
	$(if $(SIDE_BY_SIDE),@echo 'run: stages side by side; each prints when it ends (-j1: one by one with progress)')
	+@$(MAKE) $(SIDE_BY_SIDE) run-built
	@echo 'run: results are in $(RESULTS)/$(DATASET)/$(if $(SEVERAL_VARIANTS),<variant>,$(VARIANT))/ (make report: tables and pages)'

.PHONY: run-built
run-built:
	@mkdir -p $(RESULTS) && touch $(LOCK) || { \
	  echo 'run: expected RESULTS=<a folder that you may write to>' >&2; exit 2; }
	@flock --nonblock --conflict-exit-code 75 $(LOCK) true || test $$? -ne 75 || \
	  echo 'run: waiting for another run of $(DATASET) in $(RESULTS)'
	+@if test -e $(LOCK); then flock $(LOCK) $(MAKE) locked-run; else $(MAKE) locked-run; fi

.PHONY: locked-run
locked-run: locked-plan
	+@if test -e $(PLAN); then $(MAKE) --keep-going $(SEVERAL_JOBS) -f $(PLAN) BIN=$(BIN) THREADS=$(THREADS) $(GOAL); \
	else echo '# then the stages that $(PLAN) lists'; fi

# What of the plan is made: all variants, or `imports`.
GOAL := all

# Killed stages leave temporaries and what says that they began. (Those of exports and pages may be of a run beside
# this one.) After the clock was set back, files from the future would pass for newer than what changes from now on:
# their stamps go, and they are of now.
.PHONY: locked-plan
locked-plan:
	@if test -d $(RESULTS)/$(DATASET); then \
	  find $(RESULTS)/$(DATASET) -name '.*.tmp' -not -path '*/export/*' -not -name '.report.*' -delete; \
	  find $(RESULTS)/$(DATASET) -name done.begun -delete; \
	  find $(RESULTS)/$(DATASET) -type f -newermt now \( -name done -delete -o -exec touch {} + \); fi
	$(if $(wildcard $(BIN)/soslam-plan),$(if $(wildcard $(DATA_ROOT)/$(DATASET)),+))@$(PLAN_COMMAND)

# Rendered once, and again when the scene changes.
define scene-rule
$(DATA_ROOT)/$(call scene-name,$(1))-seed%/run.json: $(1) | $(BIN)/soslam-synthesise
	@echo '[$$(notdir $$(@D))] synthesise'
	@$$(LAUNCH) $(BIN)/soslam-synthesise --scene $(1) --seed $$* --output $$(@D) --threads $(THREADS) $$(QUIET)
endef
$(foreach scene,$(SCENES),$(eval $(call scene-rule,$(scene))))
$(foreach name,$(SEEDED),$(eval swept/$(name): $(DATA_ROOT)/$(name)/run.json))

.PHONY: scenes
scenes: $(SEEDED:%=$(DATA_ROOT)/%/run.json)

.PHONY: sweep
sweep: build ## Run DATASETS and SCENES with SEEDS through VARIANT=<name>|all; with -j, side by side
	+@$(MAKE) --keep-going $(SEVERAL_JOBS) $(SWEEP:%=swept/%)

.PHONY: $(SWEEP:%=swept/%)
$(SWEEP:%=swept/%):
	+@$(MAKE) run-built DATASET=$(@F)

.PHONY: submit
submit: build ## Queue with Slurm what `make sweep` would run; `make status` then shows it
	+@$(MAKE) --keep-going $(SEVERAL_JOBS) scenes
	@mkdir -p $(RESULTS)
	$(if $(findstring n,$(firstword -$(MAKEFLAGS))),,+)@pipelines/slurm/submit $(RESULTS) $(BIN) '$(SWEEP)' $(SBATCH)

.PHONY: ablation
ablation: ## Run DATASET=<name> through the ablations of docs/shapes.md, into RESULTS/ablation
	+@$(MAKE) run PIPELINES=pipelines/ablation RESULTS=$(RESULTS)/ablation

REPORT = $(BIN)/soslam-report --results $(RESULTS) --published pipelines/published.json \
  --datasets $(or $(wildcard $(PIPELINES)/datasets),pipelines/datasets) \
  $(addprefix --settings ,$(wildcard $(PIPELINES)/report.json)) --output $(RESULTS)/tables.md

.PHONY: tables
tables: build ## Compare all variants of all datasets in RESULTS: tables.md, tables/*.csv, tables/*.tex
	@$(REPORT)

.PHONY: results-page
results-page: build ## Renew the tables of docs/results.md from RESULTS, with what make tables makes
	@$(REPORT) --page docs/results.md > /dev/null

.PHONY: report
report: build ## Make pages to look at: RESULTS/report.html, and one in the folder of each dataset; and the tables
	@$(BIN)/soslam-pages --results $(RESULTS) $(OUTSIDE_PATHS)
	@$(MAKE) tables

# The shell finds them: folders in results of others may have any name.
EXPORTED = $(patsubst %,$(RESULTS)/$(DATASET)/%/map.json,$(patsubst all,*,$(VARIANT)))

.PHONY: export
export: build ## Write the maps of DATASET=<name>, VARIANT=<name>|all in formats of other programs
	@status=0; found=; for map in $(EXPORTED); do \
	  test -e "$$map" || continue; \
	  found=yes; from=$${map%/map.json}; to=$$from/export; mkdir -p "$$to"; \
	  evaluated=; test ! -e "$$from/metrics.json" || evaluated=yes; \
	  $(BIN)/soslam-export --sequence "$$from/sequence.json" --map "$$map" $${evaluated:+--metrics "$$from/metrics.json"} \
	    --trajectory "$$to/trajectory.txt" --ply "$$to/landmarks.ply" --gltf "$$to/map.glb" \
	    --coco "$$to/boxes.json" --coco_dataset "$$to/images.json" --csv "$$to/landmarks.csv" || status=$$?; \
	done; \
	test "$$found" || { status=2; \
	  echo 'export: no map.json of VARIANT="$(VARIANT)" in $(RESULTS)/$(DATASET); make run writes those of Quadric and Ours...' >&2; }; \
	exit $$status

# The import runs anew where its files have changed, so that it looks at them.
.PHONY: doctor
doctor: build ## Say what import and all stages that ran for DATASET=<name> found: errors, warnings, remedies
	+@said=$$($(MAKE) run-built GOAL=imports VARIANT=planned 2>&1 > /dev/null) || \
	  test -e $(PLAN) || { echo "$$said" >&2; exit 3; }
	@$(BIN)/soslam-doctor --results $(RESULTS) --name '$(DATASET)'

.PHONY: status
status: ## Say for each dataset, variant and stage: done, stale, failed, missing, queued or running
	@$(STATUS_COMMAND)

.PHONY: explain
explain: ## Say why STAGE=<name> of DATASET=<name> and VARIANT=<name>|all would run again
	@$(STATUS_COMMAND) --explain $(STAGE)

# Datasets are where they were when they ran, unless the caller says otherwise.
DATA_ROOT_ARGUMENT = $(if $(filter-out file,$(origin DATA_ROOT)),--data_root $(DATA_ROOT))

.PHONY: verify
verify: build ## Say which files in RESULTS, or that they were made from, are no longer what was recorded
	@$(BIN)/soslam-verify --results $(RESULTS) $(DATA_ROOT_ARGUMENT)

.PHONY: check-minima
check-minima: build ## Solve each object of the maps of DATASET=<name>, VARIANT=<name>|all, alone from other yaws and sizes
	@failed=0; for map in $(RESULTS)/$(DATASET)/$(if $(filter all,$(VARIANT)),*,$(VARIANT))/map.json; do \
	  echo "$$map"; $(BIN)/soslam-check-minima --map $$map --threads $(THREADS) || failed=$$?; done; exit $$failed

.PHONY: reproduce
reproduce: build ## Run what made the variants in RESULTS once more, as recorded, and compare every byte
	@$(BIN)/soslam-reproduce --results $(RESULTS) --executables $(BIN) --threads $(THREADS) \
	  $(OUTSIDE_PATHS) $(DATA_ROOT_ARGUMENT)

.PHONY: setup
setup: ## Install the packages that are missing (apt, as root or through sudo)
	@pipelines/install-packages.sh build

.PHONY: build
build: $(BUILD)/build.ninja ## Build the executables of the stages
	@pipelines/build.sh $(BUILD) $(STAGES)

$(BUILD)/build.ninja: | setup
	@mkdir -p $(BUILD) && test -w $(BUILD) || { \
	  echo 'build: $(BUILD) cannot be written to; expected BUILD=<a folder of your own>' >&2; exit 2; }
	@cmake -S . -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON $(CMAKE_ARGS)

.PHONY: test
test: test-build ## Build everything and run the fast tests (3 minutes)
	@ctest --test-dir $(BUILD) --output-on-failure --label-regex fast -j2

.PHONY: test-slow
test-slow: test-build ## Run the slow tests: faults, browsers, videos, clusters, statistics
	@pipelines/install-packages.sh test || echo 'setup: tests that need a browser or ffmpeg are skipped'
	@ctest --test-dir $(BUILD) --output-on-failure --label-regex slow -j2

.PHONY: test-build
test-build: $(BUILD)/build.ninja
	@pipelines/install-packages.sh data || echo 'setup: tests of downloads are skipped'
	@pipelines/build.sh $(BUILD)

.PHONY: test-slurm
test-slurm: build ## Install Slurm, and run the tests of sweeps on a cluster of two nodes on this machine
	@pipelines/install-packages.sh slurm
	@pipelines/build.sh $(BUILD) slurm_test
	@SOSLAM_SLURM=required ctest --test-dir $(BUILD) --output-on-failure --tests-regex '^slurm'

# Five repetitions, each of a tenth of a second or more: the table has their medians.
.PHONY: bench
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

.PHONY: formatter
formatter:
	@pipelines/install-packages.sh format

.PHONY: format
format: formatter ## Format the sources
	@clang-format-14 -i $(SOURCES)

.PHONY: format-check
format-check: formatter ## Fail when a source is not formatted
	@clang-format-14 --dry-run -Werror $(SOURCES)

.PHONY: clean
clean: ## Delete what runs wrote to RESULTS
	@for plan in $(RESULTS)/*/plan.mk; do test ! -e "$$plan" || rm -rf "$${plan%/plan.mk}"; done
	@rm -rf $(addprefix $(RESULTS)/,tables.md tables timing.json run.json report.html bench.json bench.md .*.lock)

.PHONY: distclean
distclean: clean ## Delete the build as well
	@rm -rf $(BUILD)
