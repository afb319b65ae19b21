# Everything one does with this repository. `make` alone lists the targets.

PYTHON ?= python3
TASK ?= ramen
DATA ?= bundled
VEIL500 ?= $(VEIL500_DIR)
OUT ?= runs/$(TASK)-$(DATA)
ROBOT ?= kinematic
KITCHEN ?= kitchen4
# section VII of the paper
AFFOGATO := Take some coffee in a cup. Add ice cream of your choice. Finally, add raspberry syrup to the mixture.

VENV := .venv
comma := ,
BIN := $(VENV)/bin
# The copy of pyproject.toml that .venv/ was made from: compared by content, so a fresh checkout of the same
# file, whatever its date, asks nothing of the network.
STAMP := $(VENV)/.made-from-pyproject.toml
# The same for the main job and for the studio, which need neither what tests need nor a compiler.
JOB := $(VENV)/.made-for-the-job-from-pyproject.toml
STUDIO := $(VENV)/.made-for-the-studio-from-pyproject.toml
# The versions that were tested; `make LOCK=` takes the newest that pyproject.toml allows.
LOCK ?= requirements.lock
PIP = $(BIN)/python -m pip install --disable-pip-version-check --progress-bar on $(if $(wildcard $(LOCK)),--constraint $(LOCK))

.DEFAULT_GOAL := help
.PHONY: all-tests
.PHONY: help setup lock experiment demo studio test test-browser test-data check style format lint types docs examples bench clean

help: ## List the targets.
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo
	@echo "  make experiment takes TASK=ramen|all DATA=bundled|veil500 VEIL500=DIR MODELS=A,B JOBS=N SEED=N OUT=DIR"
	@echo "  STEP=all|robot|report, ROBOT=kinematic|physics|off, and ARGS='…' for any other option of tmd experiment"
	@echo "  make demo takes KITCHEN=kitchen4 SEED=N, and ARGS='--kinematic' or any other option of tmd run"
	@echo "  make studio takes KITCHEN=kitchen4, and ARGS='--port 8081' or any other option of tmd studio"
	@echo "  every target takes PYTHON=python3.12, the interpreter that .venv/ is made with, and LOCK= for the newest versions"

setup: ## Make .venv/ with everything in it (once; the other targets do it by themselves).
	@$(call current,$(STAMP)) || $(MAKE) --no-print-directory $(STAMP)

# What is installed and what is downloaded stays where it is when this is stopped: the same command goes on from there.
.PHONY: venv job studio-setup $(STAMP) $(JOB) $(STUDIO)
venv:
	@command -v $(PYTHON) >/dev/null || { echo "error: there is no $(PYTHON); name an interpreter, 3.11 or newer: make PYTHON=python3.12" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "error: tmd needs Python 3.11 or newer, and $(PYTHON) is older; name another: make PYTHON=python3.12" >&2; exit 1; }
	@$(BIN)/python -c '' 2>/dev/null || $(PYTHON) -m venv --clear $(VENV)

# $(call installed,EXTRAS)
define installed
	@$(PIP) --editable '.[$(1)]'
	@$(BIN)/python -m compileall -q tmd  # each start of the program is quicker, wherever Python may not write
	@$(BIN)/python -m tmd.planning || true
	@cp pyproject.toml $@
endef

# $(call current,STAMPS): whether one of them was made from this pyproject.toml
current = $(BIN)/python -c '' 2>/dev/null && { $(foreach stamp,$(1),cmp -s pyproject.toml $(stamp) ||) false; }

$(STAMP): venv
	@echo "installing everything, tests and tools too, into $(VENV)/: 2.3 GB on disk, about 4 minutes; stop and go on as you like …"
	$(call installed,dev)

job:
	@$(call current,$(STAMP) $(JOB)) || $(MAKE) --no-print-directory $(JOB)

$(JOB): venv
	@echo "installing what the main job needs into $(VENV)/: 1.8 GB on disk, about 3 minutes; stop and go on as you like …"
	$(call installed,fast$(comma)robot)

studio-setup:
	@$(call current,$(STAMP) $(STUDIO)) || $(MAKE) --no-print-directory $(STUDIO)

$(STUDIO): venv
	@echo "installing what the studio needs into $(VENV)/: 1.7 GB on disk, about 2 minutes; stop and go on as you like …"
	$(call installed,fast$(comma)studio)

lock: setup ## Write the versions in .venv/ to requirements.lock, after the tests have passed.
	@{ grep '^#' requirements.lock; $(BIN)/python -m pip freeze --exclude-editable; } > requirements.lock.new
	@mv requirements.lock.new requirements.lock

experiment: job ## Run the main job: train, predict, score, print the table.
	@$(BIN)/tmd experiment --task '$(TASK)' --data '$(DATA)' --out '$(OUT)' \
		$(if $(VEIL500),--veil500 '$(VEIL500)') $(if $(MODELS),--models '$(MODELS)') \
		$(if $(JOBS),--jobs '$(JOBS)') $(if $(SEED),--seed '$(SEED)') $(if $(STEP),--step '$(STEP)') --robot '$(ROBOT)' $(ARGS)

demo: job ## Let a simulated PR2 make the affogato of the paper, and film it.
	@mkdir -p runs/demo
	@$(BIN)/tmd run '$(KITCHEN)' '$(AFFOGATO)' --seed '$(or $(SEED),0)' \
		--video runs/demo/affogato.mp4 --strip runs/demo/affogato.png --log runs/demo/affogato.jsonl $(ARGS); \
	code=$$?; echo "film: runs/demo/affogato.mp4, one picture for each instruction: runs/demo/affogato.png"; exit $$code

studio: studio-setup ## Open the studio: a page in the browser to watch, correct and demonstrate.
	@$(BIN)/tmd studio --environment '$(KITCHEN)' $(ARGS)

# Everything but what needs a browser or the real data, which the next two targets run; ARGS are pytest's.
test: setup ## Run the tests, but for those in a browser and on real data.
	@VEIL500_DIR= $(BIN)/python -m pytest -n auto --dist worksteal --ignore tests/studio/browser $(ARGS)

test-browser: setup ## Run the tests of the studio in a browser.
	@$(BIN)/python -m pytest -n auto --dist worksteal tests/studio/browser $(ARGS)

test-data: setup ## Run the tests on real data: VEIL500=DIR, or VEIL500_DIR in the environment.
	@test -n '$(VEIL500)' || { echo "error: name the directory of VEIL-500: make test-data VEIL500=DIR" >&2; exit 1; }
	@VEIL500_DIR='$(VEIL500)' $(BIN)/python -m pytest -n auto --dist worksteal $(DATA_TESTS) $(ARGS)

DATA_TESTS := tests/datasets tests/evaluation/test_protocol.py tests/evaluation/test_metrics.py \
	tests/evaluation/test_predefined.py tests/cli/test_exit_codes.py tests/language/test_accuracy.py

all-tests: setup
	@$(BIN)/python -m pytest -n auto --dist worksteal $(ARGS)

check: all-tests style ## What CI runs: all tests (with VEIL500_DIR on real data as well), format, lint, types.

style: setup ## Check format, lint and types, and change nothing.
	@$(BIN)/ruff format --check .
	@$(MAKE) --no-print-directory lint types

format: setup ## Lay out the code, and mend what lint can mend.
	@$(BIN)/ruff format .
	@$(BIN)/ruff check --fix .

lint: setup ## Lint.
	@$(BIN)/ruff check .

types: setup ## Check types.
	@$(BIN)/mypy

docs: setup ## Run the examples in the pages, and check their links.
	@$(BIN)/python -m pytest -n auto --dist worksteal tests/test_docs.py

examples: setup ## Run the examples in the pages, and write what they print into the pages.
	@$(BIN)/python -m tests.test_docs

bench: setup ## Run the benchmarks.
	@set -e; for script in experiments/bench/*.py; do echo "== $$script"; $(BIN)/python "$$script"; done

clean: ## Remove caches and build products; .venv/ and runs/ stay.
	@rm -rf build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -not -path './$(VENV)/*' -prune -exec rm -rf {} +
