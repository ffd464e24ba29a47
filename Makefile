# The commands that people and CI type. Needs a POSIX system with GNU make 3.81 (macOS) or later.

.PHONY: help run test lint format translations lock packages docs bundle clean

BIN := .venv/$(if $(filter Windows_NT,$(OS)),Scripts,bin)

help:
	@echo 'make run                   open the editor on a bundled cartoon'
	@echo 'make run FILE=picture.png  open that picture, or a saved project'
	@echo 'make test                  run all tests, including those of the window; needs no display'
	@echo 'make test ARGS="-k mesh"   pass options on to pytest'
	@echo 'make lint                  ruff, ruff format --check, mypy, import contracts'
	@echo 'make format                let ruff fix and format the code'
	@echo 'make translations           bring akap_editor/locale/*.po up to date with the code'
	@echo 'make lock                  update .ci/requirements.txt, what CI installs; needs uv'
	@echo 'make packages              wheel and sdist in dist/'
	@echo 'make docs                  the documentation as a site in out/site'
	@echo 'make bundle                dist/akap-editor, which runs without Python'
	@echo 'make clean                 remove .venv, caches and output'
	@echo
	@echo 'PYTHON=python3.12 chooses the Python that .venv is made with (3.11 or later).'

run:
	@sh tools/setup.sh run
	@if [ -n "$$FILE" ]; then $(BIN)/akap-editor edit "$$FILE"; else $(BIN)/akap-editor edit --bundled elephant; fi

# Without DISPLAY the tests open their windows on an Xvfb of their own, never on the user's screen.
test:
	@sh tools/setup.sh test
	@env -u PYTHONDONTWRITEBYTECODE $(BIN)/python tools/precompile.py
	env -u DISPLAY -u WAYLAND_DISPLAY -u PYTHONDONTWRITEBYTECODE $(BIN)/python -m pytest -n auto --dist worksteal $(ARGS)

lint:
	@sh tools/setup.sh lint
	$(BIN)/python -m ruff check .
	$(BIN)/python -m ruff format --check .
	$(BIN)/python -m mypy
	$(BIN)/lint-imports --no-logo --no-cache

format:
	@sh tools/setup.sh lint
	$(BIN)/python -m ruff check --fix .
	$(BIN)/python -m ruff format .

translations:
	@sh tools/setup.sh lint
	$(BIN)/python tools/translations.py

lock:
	uv pip compile pyproject.toml --extra dev --universal --generate-hashes --quiet \
		--custom-compile-command 'make lock' --output-file .ci/requirements.txt

packages:
	@sh tools/setup.sh lint
	$(BIN)/python -m hatchling build -d dist

docs:
	@sh tools/setup.sh lint
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	$(BIN)/python -m mkdocs build --quiet --strict --site-dir out/site

bundle:
	sh tools/bundle/build.sh

clean:
	rm -rf .venv out dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
