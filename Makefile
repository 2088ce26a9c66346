# `make run` is the main job, `make test-fast` the inner loop, `make check test` what a change must pass. Each makes its
# own environment. `make prove` is what takes long; `make prove PART=1/10` a tenth of it.
PYTHON ?= python3
VENV ?= .venv
BIN = $(VENV)/bin

# Container images like to set it; hundreds of processes start in the tests, and each would compile the package anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test prove test-fast coverage lint check docs report release-check bench clean
.DELETE_ON_ERROR:

run: $(VENV)/.run
	$(BIN)/automotive-cosim run --pair

test: $(VENV)/.dev
	$(BIN)/python -m pytest -n auto --dist worksteal --durations=10

prove: $(VENV)/.dev
	$(BIN)/python -m pytest -n auto --dist worksteal --durations=10 --prove $(PART)
	$(BIN)/automotive-cosim tasks validate --suite all $(if $(PART),--part $(PART)) --seeds 0 --workers 2 \
	    --against tests/proof/traces.json

test-fast: $(VENV)/.dev
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

$(VENV)/.run: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e .
	touch $@

$(VENV)/.dev: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	touch $@ $(VENV)/.run

$(VENV)/.docs: pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	touch $@ $(VENV)/.run
