# The commands that people and CI type. Needs a POSIX system with GNU make 3.81 (macOS) or later.

.PHONY: help run test lint format clean

help:
	@echo 'make run                   open the editor on a bundled cartoon'
	@echo 'make run FILE=picture.png  open that picture, or a saved project'
	@echo 'make test                  run all tests, including those of the window; needs no display'
	@echo 'make test ARGS="-k mesh"   pass options on to pytest'
	@echo 'make lint                  ruff, ruff format --check, mypy, import contracts'
	@echo 'make format                let ruff fix and format the code'
	@echo 'make clean                 remove .venv, caches and output'
	@echo
	@echo 'PYTHON=python3.12 chooses the Python that .venv is made with (3.11 or later).'

run:
	@sh tools/setup.sh run
	@if [ -n "$$FILE" ]; then .venv/bin/akap-editor edit "$$FILE"; else .venv/bin/akap-editor edit --bundled elephant; fi

# Without DISPLAY the tests open their windows on an Xvfb of their own, never on the user's screen.
test:
	@sh tools/setup.sh test
	env -u DISPLAY -u WAYLAND_DISPLAY .venv/bin/python -m pytest -n auto --dist worksteal $(ARGS)

lint:
	@sh tools/setup.sh lint
	.venv/bin/python -m ruff check .
	.venv/bin/python -m ruff format --check .
	.venv/bin/python -m mypy
	.venv/bin/lint-imports --no-logo --no-cache

format:
	@sh tools/setup.sh lint
	.venv/bin/python -m ruff check --fix .
	.venv/bin/python -m ruff format .

clean:
	rm -rf .venv out dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
