"""The lock file holds whatever pyproject.toml asks for, on each system that CI runs."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / ".ci" / "requirements.txt"
SYSTEMS = {"linux": ("Linux", "posix"), "darwin": ("Darwin", "posix"), "win32": ("Windows", "nt")}
PYTHONS = ("3.11", "3.12", "3.13", "3.14")


@pytest.fixture(scope="module")
def locked() -> dict[str, list[Requirement]]:
    """The entries of the lock file by name; a package may have several, for different Pythons."""
    lines = LOCK.read_text("utf-8").replace("\\\n", " ").splitlines()
    entries: dict[str, list[Requirement]] = {}
    for line in lines:
        pinned = line.partition("--hash")[0].strip()
        if pinned and not pinned.startswith("#"):
            assert " --hash=sha256:" in line, f"{pinned} has no checksum"
            requirement = Requirement(pinned)
            entries.setdefault(normalized(requirement.name), []).append(requirement)
    return entries


def normalized(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def asked_for() -> list[str]:
    """The dependencies of the program and of its development."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return [*project["dependencies"], *project["optional-dependencies"]["dev"]]


def holds(marker: Marker | None, environment: dict[str, str]) -> bool:
    return marker is None or marker.evaluate(environment)


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("python", PYTHONS)
def test_the_lock_file_holds_each_dependency(locked, system, python):
    """If it fails: `make lock`."""
    platform, name = SYSTEMS[system]
    environment = {"sys_platform": system, "platform_system": platform, "os_name": name}
    environment |= {"python_version": python, "python_full_version": f"{python}.0"}
    for text in asked_for():
        wanted = Requirement(text)
        if not holds(wanted.marker, environment):
            continue
        entries = locked.get(normalized(wanted.name), [])
        versions = [next(iter(each.specifier)).version for each in entries if holds(each.marker, environment)]
        assert len(versions) == 1, f"{wanted.name}: {versions or 'missing'}"
        assert versions[0] in wanted.specifier, f"{wanted} but {versions[0]}"


def test_the_lock_file_names_no_place_but_the_public_index():
    assert (
        re.findall(r"^.*(?:--\w*index|--find-links|://|file:|-e |@ ).*$", LOCK.read_text("utf-8"), re.M) == []
    )
