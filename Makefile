# `make design NAME=clay` and `make test` make what they need, from a fresh clone on.
# What a target has to say to the user stands behind its `##`; `make help` prints it.

NAME   ?=
ARGS   ?=
PYTHON ?= python3
# Test processes side by side; each holds the CAD kernel, about half a gigabyte.
JOBS   ?= 2

VENV      := .venv
BIN       := $(VENV)/bin
HERE      := $(VENV)/.here
CREATED   := $(VENV)/.created
INSTALLED := $(VENV)/.installed
TESTABLE  := $(VENV)/.installed-test
READY     := $(VENV)/.installed-dev
PINS      := pyproject.toml constraints.txt

# Without build isolation the build tool is a pinned one too, and nothing is fetched for it twice.
PIP_INSTALL := $(BIN)/python -m pip install $(if $(CI),--quiet) --disable-pip-version-check --constraint constraints.txt
INSTALL     := $(PIP_INSTALL) --no-build-isolation --editable

define CHECK_PYTHON
@command -v $(PYTHON) >/dev/null || { echo "fpcad needs Python 3.11 or newer, and there is no $(PYTHON); name another as in: make test PYTHON=python3.12" >&2; exit 1; }
@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "fpcad needs Python 3.11 or newer, and $(PYTHON) is $$($(PYTHON) --version 2>&1); name another as in: make test PYTHON=python3.12" >&2; exit 1; }
@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { echo "$(PYTHON) cannot make virtual environments; on Debian and Ubuntu the package python3-venv is missing" >&2; exit 1; }
endef

ifneq ($(filter design,$(MAKECMDGOALS)),)
ifeq ($(NAME),)
$(error make design: name one of designs/*.yaml, as in: make design NAME=clay)
endif
endif

.NOTPARALLEL:
.DELETE_ON_ERROR:
.PHONY: help design test bench lint format schema page firmware soak system-packages install hooks clean distclean

help: ## Print this list.
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-16s %s\n", $$1, $$2}' $(firstword $(MAKEFILE_LIST))
	@echo "Variables: NAME (a design), ARGS (more arguments), PYTHON (interpreter, 3.11 or newer), JOBS (test processes)."

design: $(INSTALLED) ## Make the hand of designs/NAME.yaml in build/NAME: make design NAME=clay
	$(BIN)/fpcad design $(NAME) $(ARGS)

test: $(TESTABLE) ## Run the tests; ARGS are pytest's, as in: make test ARGS=tests/select
	$(BIN)/python -m pytest --numprocesses $(JOBS) --dist loadfile --no-loadscope-reorder $(ARGS)

bench: $(INSTALLED) ## Measure solver, paths and sampling beside their baselines; build/bench.json.
	$(BIN)/python -m benchmarks.speed $(ARGS)

lint: $(READY) ## Check style and types with ruff and pyright.
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/pyright

format: $(READY) ## Bring the code into ruff's format and mend what ruff can mend.
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

schema: $(INSTALLED) ## Write the JSON schema of specs, for editors, to build/spec.schema.json.
	$(BIN)/fpcad schema > build/.spec.schema.json
	mv build/.spec.schema.json build/spec.schema.json

page: ## Build the report's script from fpcad/look/page/src; needs Node.js and npm, users do not.
	cd fpcad/look/page && npm ci --ignore-scripts && npm run build

firmware: ## Build the firmware for this machine, which `fpcad run-trajectory --port fw` starts.
	$(MAKE) -C firmware_host host

soak: $(TESTABLE) firmware ## Run the long tests of link and firmware, some twenty minutes; results go to the screen.
	$(BIN)/python -m pytest -s $(wildcard tests/soak/soak_*.py) $(ARGS)

system-packages: ## Tell which system libraries are missing on Debian or Ubuntu, and how to get them.
	@.ci/system-packages

install: $(INSTALLED) ## Install fpcad with all that it needs in .venv; the other targets do it by themselves.

hooks: $(READY) ## Have git run the checks before each commit.
	$(BIN)/pre-commit install

clean: ## Remove everything made in build/, and caches; keep .venv.
	find build -mindepth 1 -maxdepth 1 ! -name .gitkeep -exec rm -rf {} +
	rm -rf .pytest_cache .ruff_cache .hypothesis *.egg-info
	find . -path ./$(VENV) -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean ## Remove .venv as well.
	rm -rf $(VENV)

$(INSTALLED): $(CREATED) $(PINS)
	@echo "Installing fpcad's packages in $(VENV): about 2 GB, some minutes on the first run."
	$(PIP_INSTALL) setuptools
	$(INSTALL) '.[physics,pictures]'
	@touch $@

$(TESTABLE): $(CREATED) $(PINS)
	@echo "Installing fpcad's packages and its tests' in $(VENV): about 2.5 GB, some minutes on the first run."
	$(PIP_INSTALL) setuptools
	$(INSTALL) '.[test]'
	@touch $(INSTALLED) $@

$(READY): $(CREATED) $(PINS)
	@echo "Installing fpcad's packages and the developers' tools in $(VENV): about 3 GB, some minutes on the first run."
	$(PIP_INSTALL) setuptools
	$(INSTALL) '.[dev]'
	@touch $(INSTALLED) $(TESTABLE) $@

# A copied or moved clone would run the old one's code out of its old .venv, so it gets a new one.
ifneq ($(shell cat $(HERE) 2>/dev/null),$(CURDIR))
$(CREATED): FORCE
endif

$(CREATED):
	$(CHECK_PYTHON)
	$(PYTHON) -m venv --clear $(VENV)
	@echo "$(CURDIR)" > $(HERE)
	@touch $@

FORCE:
