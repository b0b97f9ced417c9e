# The few commands of daily work; CMakeLists.txt holds the build itself.
#
# PARTICLS_WERROR=1 in the environment makes compiler warnings errors, PREFIX is where `make install` puts things.

SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help packages build run check prove bench format install clean

BUILD := build/release
PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
WERROR := $(if $(filter-out 0,$(PARTICLS_WERROR)),ON,OFF)

help: ## list these commands
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 12

packages: ## install the Debian packages that are missing
	@scripts/install-packages

build: packages ## build the program as build/release/bin/particls
	@cmake --preset release -DPARTICLS_WERROR=$(WERROR)
	@cmake --build $(BUILD) -j $(JOBS)

run: build ## run the main example and make its plot
	@scripts/run-example uniaxial-compression

check: build ## run all tests
	@ctest --test-dir $(BUILD) --output-on-failure --no-label-summary -j $(JOBS)

prove: build ## run the long verification campaign, which writes docs/verification.md and docs/contact-detection.md
	@bash tests/prove/prove.sh

bench: build ## run the benchmarks, which write docs/performance.md
	@bash bench/bench.sh

format: ## lay out all C files with clang-format
	@scripts/format

install: build ## install below PREFIX (/usr/local)
	@cmake --install $(BUILD) --prefix "$(PREFIX)"

clean: ## remove what was built, not the results of runs
	@cmake -E rm -rf build/release build/debug build/asan build/tsan
