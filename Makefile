# The everyday commands, thin over the CMake presets. `make help` lists them; nothing is installed or built by a bare
# `make`. Variables: PRESET=release|debug|asan|..., JOBS=N (compile jobs), INSTALL=no (check for packages, never install).

PRESET  ?= release
JOBS    ?= $(shell tools/build_jobs.sh)
INSTALL ?= yes
# Set to nothing when absent, so that a cache made with ccache still works after ccache is gone.
CCACHE  := $(shell command -v ccache)

CONFIGURE = cmake --preset $(1) -DCMAKE_CXX_COMPILER_LAUNCHER=$(CCACHE)
BUILD     = cmake --build --preset $(1) --parallel $(JOBS)
TEST      = ctest --preset $(1) --parallel 2
SOURCES   = find include src apps bench tests examples bindings \( -name '*.h' -o -name '*.cpp' \) -print 2>/dev/null | sort

.DEFAULT_GOAL := help
.PHONY: help dependencies build demo test bench measuring micro leaks docs format format-check tidy asan tsan clang clean

help:  ## this list
	@awk -F':.*## ' '/^[a-z -]+:.*## / {printf "  make %-13s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

dependencies:  ## install the Debian packages that are missing (as root, or through sudo)
	@tools/install_dependencies.sh --install=$(INSTALL)

build: dependencies  ## the program, optimised: build/release/bin/boxwood
	$(call CONFIGURE,$(PRESET))
	$(call BUILD,$(PRESET)) --target boxwood_program

demo: override PRESET = release
demo: build  ## build, compare all builders on a scene made here, draw two pictures into out/
	@tools/demo.sh build/release/bin/boxwood out

test: dependencies  ## build everything and run every test
	$(call CONFIGURE,$(PRESET))
	$(call BUILD,$(PRESET))
	$(call TEST,$(PRESET))

bench: override PRESET = release
bench: build  ## measure all builders beside all rivals installed, and the duel with Embree; MESHES="a.ply ..." adds yours
	@tools/bench.sh build/release/bin/boxwood out $(MESHES)

MEASURING = micro_benchmarks check_leaks check_agreement
measuring: dependencies  ## build the measuring programs: build/release/bin/{micro_benchmarks,check_leaks,check_agreement}
	$(call CONFIGURE,release)
	$(call BUILD,release) --target $(MEASURING)

micro: measuring  ## micro-benchmarks of builders and kernels
	build/release/bin/micro_benchmarks

leaks: measuring  ## count rays that escape from inside a closed surface, Embree's beside ours (minutes)
	build/release/bin/check_leaks

docs: build  ## bring the generated tables up to date and check the documentation
	python3 tools/check_docs.py --program build/$(PRESET)/bin/boxwood --write

format:  ## rewrite all sources in the project's format (clang-format 14)
	@$(SOURCES) | xargs clang-format -i

format-check:  ## fail when a source is not in the project's format
	@$(SOURCES) | xargs clang-format --dry-run --Werror

tidy: dependencies  ## clang-tidy over src and apps
	$(call CONFIGURE,$(PRESET)) -B build/tidy -DBOXWOOD_PRECOMPILE=OFF -DBOXWOOD_UNITY=OFF
	tools/run_tidy.sh build/tidy $(JOBS)

asan tsan clang: dependencies  ## build and run the tests under a sanitizer; clang: under asan's, by clang++, warnings are errors
	$(call CONFIGURE,$@)
	$(call BUILD,$@)
	$(call TEST,$@)

clean:  ## remove everything built and drawn
	rm -rf build out
