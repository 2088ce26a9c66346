# `make run` is the main job, `make test-fast` the inner loop, `make check test` what a change must pass. Each makes its
# own environment. `make prove` is what takes long; `make prove PART=1/10` a tenth of it.
PYTHON ?= python3
VENV ?= .venv
BIN = $(VENV)/bin
PIP = $(BIN)/python -m pip --disable-pip-version-check
# Those that hold for every task and cost little; the tests try the others, and `GATES=all` all of them.
GATES ?= oracle,start,slip,prefix,undone,near,coupled,knowable,lawful,policy,law,sight,place,world
WHAT = -c constraints.txt -e '.$(if $(filter run,$*),,[$*])'

# Container images like to set it; hundreds of processes start in the tests, and each would compile the package anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test prove test-fast coverage lint check docs report release-check bench clean
.DELETE_ON_ERROR:

run: $(VENV)/.run
	$(BIN)/automotive-cosim run --pair --seed 3

test: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist worksteal --durations=10

prove: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist worksteal --durations=10 --prove $(PART)
	$(BIN)/automotive-cosim tasks validate --suite all $(if $(PART),--part $(PART)) --seeds 0 --workers 2 \
	    --gates $(GATES) --against tests/proof/traces.json

test-fast: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist worksteal -m "not sumo and not slow" -q

coverage: $(VENV)/.dev
	$(BIN)/python -m pytest -n auto --dist worksteal -m "not sumo and not slow" -q --cov --cov-report=term:skip-covered

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

check: lint
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/pyright

docs: $(VENV)/.docs
	$(BIN)/python -m sphinx -q -W --keep-going -b html docs docs/_site

report: docs
	chromium --headless --no-sandbox --disable-gpu --no-pdf-header-footer --virtual-time-budget=5000 \
	    --print-to-pdf=docs/_site/report.pdf "file://$(CURDIR)/docs/_site/report.html"

release-check: $(VENV)/.dev $(VENV)/.docs
	.ci/release

bench: $(VENV)/.run
	$(BIN)/automotive-cosim bench

clean:
	rm -rf $(VENV) build dist docs/_made docs/_site runs *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache

# What each kind of target needs, and says while it is installed.
$(VENV)/.run: NEEDS = the package: 35 packages, 0.6 GB
$(VENV)/.test: NEEDS = the package and what the tests need: 119 packages, 1.8 GB
$(VENV)/.dev: NEEDS = the package, what the tests need, and the checkers: 135 packages, 2.1 GB
$(VENV)/.docs: NEEDS = the package and Sphinx: 61 packages, 0.6 GB

# uv takes a fraction of pip's time. Where it cannot (it knows pip's index and, like pip, the system's certificates, but not pip's
# other settings), pip does it.
$(VENV)/.%: pyproject.toml constraints.txt
	@echo "$$(date +%T) set-up, once: an environment in $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@echo "$$(date +%T) uv, which installs the rest"
	@$(PIP) install --quiet -c constraints.txt uv || true
	@echo "$$(date +%T) $(NEEDS)"
	@index=$$($(PIP) config list | sed -n "s/.*\.index-url='\(.*\)'/\1/p" | tail -1); \
	    UV_SYSTEM_CERTS=1 $(BIN)/uv pip install --python $(BIN)/python $${index:+--default-index "$$index"} $(WHAT) || \
	    { echo "$$(date +%T) uv could not; pip installs the same, which takes longer"; $(PIP) install $(WHAT); }
	@touch $@ $(VENV)/.run $(if $(filter dev,$*),$(VENV)/.test)
	@echo "$$(date +%T) set up"
