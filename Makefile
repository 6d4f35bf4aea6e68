# `make` alone lists the targets. Everything happens in .venv, which `make setup` creates.
.DEFAULT_GOAL := help
.PHONY: help setup figures results verify report interactive test test-all mutate bench docs lint size clean

PYTHON ?= python3
BIN := .venv/bin
STAMP := .venv/installed
EXTRA := .venv/interactive
STUDIES := paper convergence
PAGE := studies/interactive/web/page
PRETTIER := npx --yes prettier@3.10.1 --print-width 118

# One thread: the matrices are small, and timings must not depend on what else runs.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
# Bytecode is kept where a machine is set not to: each process of the tests would compile all sources again.
export PYTHONDONTWRITEBYTECODE :=

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-11s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(STAMP)  ## create .venv with the pinned packages and this one, compile the kernels

$(STAMP): requirements.lock pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed")'
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/python -m studies compile
	@touch $@

figures: $(STAMP)  ## compute the figures of the paper and the convergence studies again, refresh the README
	$(BIN)/python -m studies run paper convergence
	$(BIN)/python -m studies readme

results: $(STAMP)  ## compute all studies again (6 minutes), refresh the README
	$(BIN)/python -m studies run all
	$(BIN)/python -m studies readme

verify: $(STAMP)  ## compute STUDIES="paper convergence" again and compare them with the stored results
	$(BIN)/python -m studies verify $(STUDIES) --fresh-too

report: $(STAMP)  ## compile report/validation.pdf from the stored results
	$(BIN)/python -m report.build

interactive: $(EXTRA)  ## drive the pivot by camera or mouse in the browser; ARGS="--film demo" passes options on
	$(BIN)/python -m studies interactive $(ARGS)

$(EXTRA): $(STAMP) requirements-interactive.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements-interactive.lock
	@echo "compiling the kernels of the interactive environment, once ..."
	$(BIN)/python -c "from studies.interactive.web.server import warm_up; warm_up()"
	@touch $@

test: $(STAMP)  ## run the quick tests
	$(BIN)/python -m pytest -q -n auto --dist worksteal -m "not slow"

test-all: $(STAMP)  ## run all tests
	$(BIN)/python -m pytest -q -n auto --dist worksteal

mutate: $(STAMP)  ## apply mutants to a copy of the code: a named test must detect each (25 minutes)
	$(BIN)/python -m tests.mutate $(ARGS)

bench: $(STAMP)  ## time the solvers; counters are stored beside the seconds
	@mkdir -p .benchmarks
	$(BIN)/python -m pytest -q tests/bench --benchmark-enable --benchmark-sort=name \
		--benchmark-columns=min,median,iqr,ops,rounds --benchmark-json=.benchmarks/speed.json

docs: $(STAMP)  ## build the API reference into docs/_build/html, from docstrings
	$(BIN)/python -m sphinx -W --keep-going -n -q docs docs/_build/html
	@echo "docs/_build/html/index.html"

lint: $(STAMP)  ## check style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	@if $(PRETTIER) --version >/dev/null 2>&1; then $(PRETTIER) --check $(PAGE)/*.js; \
	else echo "prettier: skipped, needs Node.js and a package registry"; fi

size: $(STAMP)  ## count code lines, files and public names of every package, beside the aim
	$(BIN)/python -m tests.size

clean:  ## remove .venv and every cache, but no results
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis .benchmarks build docs/_build *.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
