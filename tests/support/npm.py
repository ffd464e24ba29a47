"""Packages from npm, for tests that read exported files with the programs of others."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import pytest
from filelock import FileLock

_SECONDS = 60  # for npm, and for a script


def run_with_package(package: str, version: str, script: str, *arguments: object) -> Any:
    """What a JavaScript module prints as JSON, with a package of npm at hand.

    The package stays in the folder for temporary files. The test is skipped if there is no npm, or if it
    cannot download the package.
    """
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        pytest.skip("npm is not installed")
    folder = Path(tempfile.gettempdir()) / f"akap-editor-npm-{package.replace('/', '-')}-{version}"
    folder.mkdir(exist_ok=True)
    with FileLock(folder / "lock"):
        if not (folder / "installed").exists():
            command = [npm, "install", "--no-audit", "--no-fund", "--prefix", folder, f"{package}@{version}"]
            done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
            if done.returncode:
                pytest.skip(f"npm cannot install {package}: {done.stderr.strip().splitlines()[-1:]}")
            (folder / "installed").touch()
    (folder / "script.mjs").write_text(script)
    command = [node, folder / "script.mjs", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
