# The project's verbs. `make help` lists them.
SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DEFAULT_GOAL := help
.PHONY: help setup other-ros demo check rules test test-slow coverage lint type format docs study answer bench bench-learner film clean clean-demo

VENV ?= .venv
PACKAGES := hexapod_sim hexapod_cpg hexapod_agent hexapod_doe
ROS_PACKAGES := hexapod_node hexapod_bringup ros2_mini
CODE := $(PACKAGES) $(ROS_PACKAGES:%=ros_ws/src/%)
INTERFACES := $(shell find ros_ws/src/hexapod_interfaces -type f 2>/dev/null)
INSTALLED := $(shell find $(CODE) -name setup.py -o -name setup.cfg -o -name package.xml -o -name '*.xml' \
	-o -name '*.yaml' -o -name '*.html*' -o -name '*.launch.xml' -o -name '*.urdf' -o -name '*.json' -not -path '*/__pycache__/*' 2>/dev/null)
ENTER := export HEXAPOD_VENV='$(abspath $(VENV))'; source setup.bash
# Test processes at once: two for each core, as tests also wait. WORKERS=0 runs the tests one after
# another, in this process.
WORKERS ?= $(shell cores=$$(nproc); echo $$((cores < 4 ? 2 * cores : 8)))
BESIDE := -n $(WORKERS) --dist loadfile --no-loadscope-reorder
DEMO := bags/demo
DEMO_EPISODES := 4
STUDY := bags/study

help:  ## list the verbs
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

setup: other-ros ros_ws/install/.ready  ## make the virtual environment and build the workspace

other-ros:
	@.ci/other_ros

$(VENV)/.ready: requirements.txt requirements-ros.txt constraints.txt | other-ros
	@python=$$(.ci/prerequisites) && "$$python" -m venv $(VENV)
	@.ci/libraries $(VENV) 'the libraries and ROS 2 (0.4 GB to download, 1.5 GB on this disk)' -r requirements.txt -r requirements-ros.txt -c constraints.txt
	@touch $@

# What only tests and linters need, a demo does not wait for.
$(VENV)/.dev: $(VENV)/.ready requirements-dev.txt
	@.ci/libraries $(VENV) 'what tests and linters need (57 MB to download)' -r requirements-dev.txt -c constraints.txt
	@touch $@

ros_ws/install/.ready: $(VENV)/.ready $(INTERFACES) $(INSTALLED) | other-ros
	@echo 'Building the ROS workspace ...'
	@unset _ROS_WHEELS_BOOTSTRAP_COMPLETE; export MAKEFLAGS=-j$$(nproc); source $(VENV)/bin/activate \
	&& export AMENT_PREFIX_PATH='$(abspath $(VENV))' CMAKE_PREFIX_PATH='$(abspath $(VENV))' \
	&& cd ros_ws && python -m colcon build --symlink-install \
		--event-handlers console_cohesion- console_stderr- console_direct+ \
		--cmake-args -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF | ../.ci/progress
	@touch $@

demo: setup  ## run a small real campaign through the graph, to a report
	@$(ENTER); if python -m hexapod_doe.campaign_status --quiet $(DEMO); then \
		echo '$(DEMO) holds a finished demo, which is analysed again; `make clean-demo` forgets it'; fi
	@$(ENTER); [ -f $(DEMO)/plan.csv ] || ros2 run hexapod_doe plan --design eighth --replicates 1 --seed 1 \
		--out $(DEMO)/plan.csv
	@$(ENTER); ros2 launch hexapod_bringup campaign.launch.xml plan:=$(DEMO)/plan.csv \
		episodes:=$(DEMO_EPISODES) record_every:=$(DEMO_EPISODES) local_workers:=2 \
		"set:=['training.evaluation=$(DEMO_EPISODES)']"
	@$(ENTER); python -m hexapod_doe.campaign_status --quiet $(DEMO) || { \
		echo '$(DEMO) is not finished; `make demo` goes on, `campaign_status $(DEMO)` tells how far it is'; exit 1; }
	@$(ENTER); ros2 run hexapod_doe analyze $(DEMO) --out $(DEMO)/report

study: setup  ## run what is missing of the published study, hours of it; the estimate comes first
	@$(ENTER); python -m hexapod_doe.studies.run_study $(STUDY)

answer: setup  ## rebuild every figure and number of the study from its bags
	@$(ENTER); python -m hexapod_doe.studies.answer $(STUDY) --out docs

test: setup $(VENV)/.dev  ## run the tests, without the proofs that take minutes each
	@$(ENTER); python -m pytest -m 'not slow' $(BESIDE) $(PYTEST)

test-slow: setup $(VENV)/.dev  ## run the slow proofs
	@$(ENTER); python -m pytest -m slow $(PYTEST)

coverage: setup $(VENV)/.dev  ## tell how much of the code the tests run, as far as it runs in their processes
	@$(ENTER); python -m pytest -m 'not slow' $(BESIDE) -q $(PACKAGES:%=--cov=%) --cov=hexapod_node --cov=hexapod_bringup \
		--cov-report=term $(PYTEST)

check: setup  ## style, types and the rules of the house: what CI runs first
	@$(MAKE) --no-print-directory --jobs --output-sync=target lint type rules

rules: setup $(VENV)/.dev  ## hold the rules of the house: imports, packages, pages
	@$(ENTER); python -m pytest -q tests/test_house.py tests/test_docs.py tests/test_packages.py

lint: $(VENV)/.dev  ## check style; asks for no workspace
	@$(VENV)/bin/ruff check . && $(VENV)/bin/ruff format --check .

type: $(VENV)/.dev  ## check types; asks for no workspace
	@$(VENV)/bin/mypy $(PACKAGES:%=-p %) $(ROS_PACKAGES:%=-p %)

format: $(VENV)/.dev  ## rewrite the code in the project's style
	@$(VENV)/bin/ruff check --fix-only . ; $(VENV)/bin/ruff format .

docs: $(VENV)-docs/.ready  ## build the documentation as a site, site/index.html; asks for no workspace
	@NO_MKDOCS_2_WARNING=1 $(VENV)-docs/bin/python -m mkdocs build --strict
	@echo 'open site/index.html'

$(VENV)-docs/.ready: requirements-docs.txt constraints.txt
	@$(or $(PYTHON),python3) -m venv $(VENV)-docs
	@$(VENV)-docs/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-docs.txt -c constraints.txt
	@touch $@

bench: setup bench-learner  ## measure speed, as ratios within one run
	@$(ENTER); for bench in $(filter-out %/bench_learner.py,$(wildcard tests/benchmarks/bench_*.py)); do \
		echo "== $$bench"; python $$bench || exit 1; done

bench-learner: setup $(VENV)-bench/.ready  ## time an update beside those of other learners
	@$(ENTER); python tests/benchmarks/bench_learner.py --peers $(abspath $(VENV))-bench/bin/python

# PyTorch and stable-baselines3 are those of $(VENV); what else the others need stays out of it.
$(VENV)-bench/.ready: $(VENV)/.ready requirements-bench.txt
	@$(VENV)/bin/python -m venv $(VENV)-bench
	@$(VENV)/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))' \
		> "$$($(VENV)-bench/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/product.pth"
	@$(VENV)-bench/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-bench.txt -c constraints.txt
	@touch $@

film: setup  ## film the robot on its way, without a display
	@$(ENTER); ros2 run hexapod_agent film ros_ws/src/hexapod_bringup/agents/ABCDE.pt --out walk.gif --strip docs/images/walk.png \
		--width 330 --height 250 --zoom 1.7 --seconds 1.5 --seed 3
	@$(ENTER); strip() { name=$$1; shift; ros2 run hexapod_agent film ros_ws/src/hexapod_bringup/agents/ABCDE.pt \
		--width 240 --height 160 --seconds 9 --frames 3 --strip docs/images/scenario_$$name.png "$$@"; }; \
	strip rough --set scene.name=rough --set scene.roughness=0.03 && \
	strip stairs --set scene.name=stairs --set scene.rise=0.03 && \
	strip slope --set scene.name=slope --set scene.gradient=0.3 && \
	strip payload --set robot.payload=1.2 && \
	strip dead_leg --set robot.dead_legs=lf --set robot.fault_time=4

clean-demo:  ## forget the demo campaign, and leave what else lies in its folder
	rm -rf $(addprefix $(DEMO)/,runs logs report confirm plan.csv plan.json config.yaml progress.html failures.csv \
		campaign.lock)
	[ ! -d $(DEMO) ] || rmdir --ignore-fail-on-non-empty $(DEMO)

clean:  ## remove the virtual environment and everything built
	rm -rf $(VENV) $(VENV)-docs site ros_ws/build ros_ws/install ros_ws/log .mypy_cache .pytest_cache .ruff_cache
