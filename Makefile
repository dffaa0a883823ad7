# The project's two commands are `make demo` and `make test`; the rest is for its developers.

.PHONY: demo program check checked test test-all rust-test python-light-test python-test console-test lint rust-lint console-lint python-lint soak database console console-ready deny bench train suites board notebooks python python-light wheel sdist prepare tools

# The main job: all policies on 100 unseen days of the paper's network. The dispatch service, half of a build, is left out.
demo: prepare
	cargo build --release --locked -p vertifleet-cli --no-default-features
	./target/release/vertifleet compare --network paper --policies random,greedy,prices,rolling,mlp,gcaps,gcaps-x --days 100 --seed 1 --report out/report

# The whole workspace decides on the features of dependencies, so that the tests can use what is compiled here.
program: prepare
	cargo build --release --locked --workspace --bin vertifleet

# The settings of tests, which .cargo/checked.toml explains.
CHECKED = --config .cargo/checked.toml --release --workspace --locked
# The Python tools of lints and tests, beside the package with the extension module that the tests compile.
DEV = $(CURDIR)/target/checked/python-dev/bin

# Run this before a commit; it takes minutes: formatting, clippy, and the unit tests.
check: prepare
	cargo fmt --all --check
	cargo clippy $(CHECKED) --all-targets -- -D warnings
	cargo test $(CHECKED) --lib --bins

# Every test that needs neither a browser nor PyTorch nor Ray, documentation among them.
test:
	@scripts/groups rust-test python-light-test

# Every test. Each group runs, also after another has failed, and the last lines name those that failed.
test-all:
	@scripts/groups rust-test console-test python-light-test python-test

# The lints, which CI runs besides the tests. Those of the console and of Python use one core each, so two run at a time.
lint:
	@$(MAKE) --no-print-directory --jobs 2 --keep-going rust-lint console-lint python-lint

rust-lint: prepare tools
	cargo fmt --all --check
	cargo clippy $(CHECKED) --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc $(CHECKED) --no-deps
	scripts/prose
	PATH="$$PWD/target/tools/bin:$$PATH" cargo machete crates python fuzz
	target/tools/bin/mdbook build docs
	shellcheck .ci/run benches/table2/figure $$(find scripts -type f ! -name prose)

console-lint: console-ready
	cd web && npm run check

python-lint: prepare
	cargo build $(CHECKED) --example checked_native
	@scripts/python checked
	cd python && $(DEV)/ruff format --check . && $(DEV)/ruff check . && $(DEV)/mypy
	cd docs && $(DEV)/stubtest vertifleet._native --mypy-config-file ../python/stubtest.ini
	$(DEV)/typos

rust-test: prepare database
	cargo test $(CHECKED) --no-fail-fast

# Two tests at a time, from the root: in python/, Ray's workers would import the sources, which have no extension module.
PYTEST = pytest -c python/pyproject.toml --numprocesses 2 --dist worksteal

# The tests of the package without PyTorch and Ray, and those that need them.
python-light-test: checked
	@scripts/python checked-light
	target/checked/python-light/bin/$(PYTEST) -q --ignore python/tests/frameworks python/tests
python-test: checked
	@scripts/python checked
	$(DEV)/$(PYTEST) python/tests/frameworks python/benches

# What all tests share: their program, and the extension module of the Python package.
checked: prepare
	cargo test $(CHECKED) --no-run

# The console in headless browsers, with the tests' build of the program; and a check that web/dist
# matches web/.
console-test: checked
	@scripts/console test
	cd web && npm test && npm run dist-test && npm run e2e

# The Python package with all its extras, in python/.venv; and without PyTorch and Ray, which take 7 GB.
python: prepare
	@scripts/python
python-light: prepare
	@scripts/python light

# The PostgreSQL server for the tests of services that share a database.
database:
	@scripts/database

# Builds the console from web/ into web/dist, which is in the tree: only its developers need Node.
console: console-ready
	cd web && npm run build
console-ready: prepare
	@scripts/console build

# A long test of the service: 1,000 kills while clients write, with each kind of store, and with
# failing writes.
soak: prepare database
	VERTIFLEET_KILLS=1000 cargo test $(CHECKED) --test cli serve_killed -- --nocapture
	VERTIFLEET_WHOLE_GUIDE=1 cargo test $(CHECKED) --test cli guide::

# The programs that the lints need besides Rust and Python.
tools: prepare
	@scripts/tools

# A wheel for every Linux of the last ten years, in python/dist.
wheel: python
	rm -rf python/dist
	cd python && PATH="$$PWD/.venv/bin:$$PATH" maturin build --release --locked --zig --compatibility manylinux2014 --out dist

# The source distribution of the Python package, in python/dist.
sdist: prepare
	scripts/sdist

# Licences, versions and sources of the dependencies. Needs cargo-deny (`cargo install cargo-deny --locked`).
deny:
	cargo deny --locked check licenses bans sources

bench: prepare
	cargo bench --workspace --locked

# How the shipped weights were made; they are then copied from out/train to models/paper, those of gcaps-x to models/any, with
# their curves. Beside gcaps-x lie the curves of --seed 2 and --seed 3. The shipped gcaps-x began
# with the weights that this makes, at commit 8699f1b2c3a7: docs/src/benchmarks.md, "gcaps-x", has
# its command.
train: program
	./target/release/vertifleet train --network paper --policy gcaps --seed 1 --out out/train
	./target/release/vertifleet train --network paper --policy mlp --seed 1 --out out/train
	./target/release/vertifleet train --network paper --policy gcaps-x --seed 1 --out out/train

# The tables of the suites: hashes of their days and certified upper bounds. Changes only when a suite is added.
suites: prepare
	cargo run --release --locked -p vertifleet-study --example suites -- suites

# The result files of our own policies, and the board, a page of the book that is made from all files in results/. Roll-outs
# and planners take hours and are left out. Every further suite adds 20 to 270 kB a policy.
BOARD = paper-100,disrupted-100,paper-quick-20
board: program
	./target/release/vertifleet evaluate --suite $(BOARD) --policies greedy,random,prices,gcaps-x,gcaps-full,gcaps,mlp --results results --about origin="shipped with the program"
	./target/release/vertifleet board results --report out/board
	mkdir -p docs/src/board
	cp out/board/board.md out/board/figure-board-*.svg docs/src/board

# Runs the notebooks and writes them as pages of the book.
notebooks: python
	scripts/notebooks

prepare:
	@scripts/prepare
