# `make report`: set up, run the default suite, write the page. `make test`: set up, run the tests.
# Python 3.11 or 3.13; choose one with PYTHON=..., which renderers to install with EXTRAS=... (mitsuba, cycles, luxcore, radiance, pyrender, all),
# what to run instead of the default suite with RUN='square-light --with mc-area', which benchmarks with BENCH='--only growth'.

PYTHON ?= $(shell for p in python3 python3.13 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info[:2] not in ((3, 11), (3, 13)))' 2>/dev/null && { echo $$p; break; }; done)
EXTRAS ?= all
VENV ?= .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready-$(EXTRAS)

.PHONY: setup report nightly test gate bench soak clean

report: setup
	$(BIN)/lightproof run $(RUN)
	$(BIN)/lightproof report

nightly: setup
	$(BIN)/lightproof calibrate --budget 600
	$(BIN)/lightproof run --tags nightly --budget 7200 --cell-budget 180
	$(BIN)/lightproof report

test: setup
	@harness/system-packages tests/apt-packages.txt
	$(BIN)/python -m pytest -q

gate: setup
	$(BIN)/lightproof gate

bench: setup
	$(BIN)/python benchmarks/run.py $(BENCH)

soak: setup
	$(BIN)/python benchmarks/soak.py

setup: $(READY)

$(READY): pyproject.toml constraints.txt apt-packages.txt
	@test -n "$(PYTHON)" || { echo "Lightproof needs Python 3.11 or 3.13: install one, or name it with make PYTHON=/path/to/python"; exit 2; }
	@harness/system-packages apt-packages.txt
	$(PYTHON) -m venv $(VENV)
	PIP_CONSTRAINT=$(CURDIR)/constraints.txt PIP_BUILD_CONSTRAINT=$(CURDIR)/constraints.txt \
		$(BIN)/pip install -q -e '.[$(EXTRAS),test]'
	@touch $@

clean:
	rm -rf $(VENV) reports/runs
