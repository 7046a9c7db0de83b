# `make demo` rebuilds the example bench in the simulator; `make test` runs the tests. Both install what they need
# into .venv first. Python 3.11 or newer, git and make are all that has to be there.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test affected test-slow test-gui slowest check schemas docs ui clean
.DELETE_ON_ERROR:

demo: $(STAMP)
	$(BIN)/python examples/demo.py $(DEMO)

test: $(STAMP)
	$(BIN)/python -m pytest -n 3 -m "not slow"

# The quick tests of what changed since the merge base with main; AFFECTED="--list" only lists them.
affected: $(STAMP)
	$(BIN)/python .ci/affected.py $(AFFECTED)

test-slow: $(STAMP)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m slow

# All tests, and the 30 that cost most processor time; ONLY="not slow" leaves the slow ones out.
slowest: $(STAMP)
	PYTHONPATH=.ci $(BIN)/python -m pytest -n 2 -p slowest $(if $(ONLY),-m "$(ONLY)")

check: $(STAMP)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m pico.manifest.schema --check
	$(BIN)/python -m pico.recipes.schema --check
	$(BIN)/python .ci/state_files.py --check
	$(BIN)/python .ci/fault_page.py --check
	$(BIN)/python .ci/instrument_kinds.py --check
	$(BIN)/python .ci/safety_table.py --check
	$(BIN)/python .ci/page.py check
	$(BIN)/python .ci/wheel.py

# The page for browsers, built of ui/ into pico/server/static/; needs Node and npm.
ui: $(STAMP)
	$(BIN)/python .ci/page.py build

# The page in a real browser, against a real coordinator; says what it lacks.
test-gui: $(STAMP)
	$(BIN)/python .ci/page.py test

schemas: $(STAMP)
	$(BIN)/python -m pico.manifest.schema
	$(BIN)/python -m pico.recipes.schema

# The pages of docs/ that are printed from the code.
docs: $(STAMP)
	$(BIN)/python .ci/state_files.py
	$(BIN)/python .ci/safety_table.py
	$(BIN)/python .ci/instrument_kinds.py
	$(BIN)/python .ci/fault_page.py

$(STAMP): pyproject.toml constraints.txt tests/kernels/pictures.txt .ci/path.py .ci/install.py
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else f"PICO needs Python 3.11 or newer; {sys.executable} is {sys.version.split()[0]}. Name another one: make PYTHON=python3.12")'
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing into $(VENV) (once, one to three minutes) ..."
	@$(BIN)/python .ci/install.py -c constraints.txt setuptools wheel
	@$(BIN)/python .ci/install.py -c constraints.txt --no-build-isolation -e '.[dev]'
	@$(BIN)/python .ci/path.py
	@$(BIN)/python .ci/install.py --no-deps -r tests/kernels/pictures.txt
	@touch $(STAMP)

clean:
	rm -rf build dist *.egg-info demo
