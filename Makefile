# `make demo` rebuilds the example bench in the simulator; `make test` runs the tests. Both install what they need
# into .venv first. Python 3.11 or newer, git and make are all that has to be there.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test test-slow test-gui check schemas ui clean
.DELETE_ON_ERROR:

demo: $(STAMP)
	$(BIN)/python examples/demo.py $(DEMO)

test: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m "not slow"

test-slow: $(STAMP)
	$(BIN)/python -m pytest -n 2 -m slow

check: $(STAMP)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m pico.manifest.schema --check
	$(BIN)/python -m pico.recipes.schema --check
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

$(STAMP): pyproject.toml constraints.txt tests/kernels/pictures.txt .ci/path.py
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else f"PICO needs Python 3.11 or newer; {sys.executable} is {sys.version.split()[0]}. Name another one: make PYTHON=python3.12")'
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing into $(VENV) (once, about a minute) ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt setuptools wheel
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --no-build-isolation -e '.[dev]'
	@$(BIN)/python .ci/path.py
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps -r tests/kernels/pictures.txt
	@touch $(STAMP)

clean:
	rm -rf build dist *.egg-info demo
