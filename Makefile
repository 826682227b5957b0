# make demo | test | evidence | lint | page | golden-logs [RENEW=1] | made-floors | known-answers | motion-evidence | real-time-evidence | reach-evidence | emulator-evidence CHECKOUT=path | same-results CHECKOUT=path | take-evidence | ocel-evidence | bench | bench-peers | libraries | lock | wheel.  Needs Python >= 3.11 and make; sets everything else up in .venv.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
PEERS := .venv-peers
OCEL := .venv-ocel
RUN := $(VENV)/bin/python
READY := $(VENV)/.ready
MOTION ?= ../shared/data/motion
BY_FILE := -n 2 --dist loadfile --no-loadscope-reorder
PAGE := opsim/viewer/page
PUBLIC := deep_squat inline_lunge leg_raise shoulder_abduction shoulder_scaption side_lunge sit_to_stand

.PHONY: demo test tests evidence lint page page-packages golden-logs made-floors known-answers motion-evidence real-time-evidence reach-evidence emulator-evidence same-results take-evidence ocel-evidence bench bench-peers libraries lock wheel clean
.DEFAULT_GOAL := demo

$(READY): requirements.lock pyproject.toml
	@echo "Setting up $(VENV) with the locked packages (once) ..."
	$(PYTHON) -c 'import sys; assert sys.version_info >= (3, 11), f"Python 3.11 or newer is needed, this is {sys.version}"'
	test -x $(RUN) || $(PYTHON) -m venv $(VENV)
	$(RUN) -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(RUN) -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $(READY)

demo: $(READY)
	$(VENV)/bin/opsim run scenarios/repack_cell.yaml --overwrite

# Lint beside the tests: mypy takes one of two cores for its minute where it has no cache.
test: $(READY)
	$(MAKE) --no-print-directory -j 2 lint tests

lint: $(READY)
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .
	$(RUN) -m mypy

# File by file, the longest first (tests/conftest.py), so that both processes end together.
# The floor and the loops of movements are compiled before: else each process would compile them.
tests: $(READY)
	$(RUN) -m opsim.engine.fast_engine
	PYTHONPATH=tests $(RUN) tests/compile_kernels.py
	$(RUN) -m pytest $(BY_FILE) -m "not slow and not browser"

# What takes long: statistics of many draws, pages in a browser, properties at all their examples, known answers at full length.
evidence: $(READY)
	$(RUN) -m opsim.engine.fast_engine
	$(RUN) -m pytest $(BY_FILE) -m "slow or browser or hypothesis" --hypothesis-profile full
	PYTHONPATH=tests $(RUN) -m known_answers.show --engine fast --no-audit

bench: $(READY)
	$(RUN) -m pytest tests/bench -p no:xdist -q -s

$(PEERS)/.ready: requirements.lock pyproject.toml tests/bench/peers_requirements.txt
	@echo "Setting up $(PEERS) with the locked packages and other simulators (once) ..."
	test -x $(PEERS)/bin/python || $(PYTHON) -m venv $(PEERS)
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check -r tests/bench/peers_requirements.txt
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

bench-peers: $(PEERS)/.ready
	PYTHONPATH=tests $(PEERS)/bin/python -m bench.peers
	$(PEERS)/bin/python -m pytest tests/bench/test_align.py -p no:xdist -q -s -k fdasrsf
	$(PEERS)/bin/python -m pytest tests/bench/test_judge.py -p no:xdist -q -s -k dcors
	$(PEERS)/bin/python -m pytest tests/bench/test_bvh.py -p no:xdist -q -s -k package
	$(PEERS)/bin/python -m pytest tests/bench/test_stltsa.py -p no:xdist -q -s -k plain

# What the offline pages run is built from $(PAGE): needs node and npm; tests/test_asset.py compares.
$(PAGE)/node_modules/.package-lock.json: $(PAGE)/package-lock.json $(PAGE)/package.json
	cd $(PAGE) && npm ci --no-audit --no-fund

page-packages: $(PAGE)/node_modules/.package-lock.json

page: page-packages
	cd $(PAGE) && node build.mjs

golden-logs: $(READY)
	$(RUN) tests/golden_logs.py $(if $(RENEW),--renew)

# After a change of what made floors draw from: floors that run, a sample that has every word, and the hashes of all.
made-floors: $(READY)
	PYTHONPATH=tests:. $(RUN) -m engine_evidence.floors
	PYTHONPATH=tests:. $(RUN) -m engine_evidence.sample
	$(MAKE) --no-print-directory golden-logs RENEW=1

known-answers: $(READY)
	PYTHONPATH=tests $(RUN) -m known_answers.show

motion-evidence: $(READY)
	PYTHONPATH=tests $(RUN) -m motion_evidence.show

real-time-evidence: $(READY)
	PYTHONPATH=tests $(RUN) -m motion_evidence.real_time

# Made shelves of known truth, and recordings left out of which only a hand's place is told.
reach-evidence: $(READY)
	PYTHONPATH=tests $(RUN) -m emulator_evidence.reach
	PYTHONPATH=tests $(RUN) -m motion_evidence.reach

# CHECKOUT=path of another checkout: what the emulator of it gives, this one gives.
emulator-evidence: $(READY)
	PYTHONPATH=tests $(RUN) -m emulator_evidence.same $(CHECKOUT)

# What ships gives the results that the code of another checkout gives.
same-results: $(READY)
	PYTHONPATH=tests $(RUN) -m study_evidence.same_results $(CHECKOUT)

take-evidence: $(READY)
	PYTHONPATH=tests:. $(RUN) -m take_evidence.show -o build/take_evidence

$(OCEL)/.ready: tests/ocel_evidence/requirements.txt
	@echo "Setting up $(OCEL) with readers of OCEL 2.0, apart from everything else (once) ..."
	test -x $(OCEL)/bin/python || $(PYTHON) -m venv $(OCEL)
	$(OCEL)/bin/python -m pip install --quiet --disable-pip-version-check -r tests/ocel_evidence/requirements.txt
	@touch $@

ocel-evidence: $(READY) $(OCEL)/.ready
	PYTHONPATH=tests:. $(RUN) -m ocel_evidence.show --reader $(OCEL)/bin/python -o build/ocel_evidence

libraries: $(READY)
	$(VENV)/bin/opsim motion fit $(foreach name,$(PUBLIC),$(MOTION)/uiprmd_$(name).npz) -o scenarios/libraries/public_movements.npz
	$(RUN) -m emulator.synthetic -o scenarios/libraries/bench_work.npz
	$(RUN) -m emulator.synthetic.walking -o scenarios/libraries/walking.npz
	$(RUN) -m emulator.synthetic.handling -o scenarios/libraries/handling.npz

lock:
	test -x $(RUN) || $(PYTHON) -m venv $(VENV)
	$(RUN) -m pip install --quiet pip-tools
	$(VENV)/bin/pip-compile --quiet --extra dev,cluster,sensitivity,search,matplotlib,frames --generate-hashes --strip-extras --allow-unsafe --no-header \
	  --no-emit-index-url --no-emit-find-links --no-emit-trusted-host -o requirements.lock pyproject.toml

wheel: $(READY)
	$(RUN) -m pip wheel --quiet --no-deps --no-build-isolation -w dist .

clean:
	rm -rf $(VENV) $(PEERS) $(OCEL) $(PAGE)/node_modules build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
