#!/bin/sh
# Usage: tools/setup.sh run|test|lint
# Prepares a checkout for that purpose: installs system packages, then the project in .venv.
# Silent and quick if everything is installed. PYTHON names the Python that .venv is made with.
set -eu
cd "$(dirname "$0")/.."
purpose=$1
case $(uname -s) in
    MINGW* | MSYS* | CYGWIN*) bin=.venv/Scripts ;;
    *) bin=.venv/bin ;;
esac

fail() {
    echo "$1" >&2
    exit 1
}

has_library() { # the loader's cache lists "libGL.so.1 (libc6,x86-64) => ..."
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p | grep -qF "$1 ("
}

# Prints the Debian packages whose content this purpose needs and the system lacks.
missing_packages() {
    [ "$(uname -s)" = Linux ] && [ "$purpose" != lint ] || return 0
    has_library libGL.so.1 || echo libgl1 # a window; brings libX11 and Mesa
    has_library libEGL.so.1 || echo libegl1 # OpenGL without a display
    [ "$purpose" = test ] || return 0
    command -v Xvfb >/dev/null || echo xvfb # a display for the window tests
    command -v xdotool >/dev/null || echo xdotool # their mouse and keyboard
}

# Installs Debian packages as root or with a sudo that needs no password; otherwise prints what to type and fails.
install_packages() {
    if ! command -v apt-get >/dev/null; then
        echo "Please install what Debian calls: $*" >&2
        return 1
    fi
    if [ "$(id -u)" -eq 0 ]; then
        as_root=
    elif sudo -n true 2>/dev/null; then
        as_root="sudo -n"
    else
        echo "System packages are missing; please run:" \
            "sudo apt-get update && sudo apt-get install --no-install-recommends $*" >&2
        return 1
    fi
    echo "Installing system packages: $*"
    # On a new machine, automatic updates may hold the lock.
    set -- -qq -y --no-install-recommends -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3 "$@"
    $as_root apt-get -qq -o Acquire::Retries=3 update
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install "$@" >/dev/null
}

# Prints the Python to use: $PYTHON, or the first one that is new enough.
find_python() {
    if [ -n "${PYTHON:-}" ]; then
        set -- "$PYTHON"
    else
        set -- python3 python3.15 python3.14 python3.13 python3.12 python3.11
    fi
    found=''
    for python; do
        version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null) || continue
        case $version in
            3.1[1-9] | 3.[2-9]?) echo "$python" && return ;;
            *) found="${found:+$found, }$python $version" ;;
        esac
    done
    fail "akap-editor needs Python 3.11 or later, but found ${found:-no Python as $*}."
}

make_venv() {
    python=$(find_python)
    if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then # Debian has a separate package for venv
        package=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
        install_packages "$package" || exit 1
    fi
    "$python" -m venv --clear .venv
}

# With LOCKED=1, the packages are those of .ci/requirements.txt, with the same checksums.
pip_install() {
    pip="$bin/python -m pip --quiet --disable-pip-version-check --timeout 60 install"
    if [ -z "${LOCKED:-}" ]; then
        $pip --editable "$1"
    else
        $pip --require-hashes --requirement .ci/requirements.txt
        $pip --no-deps --no-build-isolation --editable .
    fi
}

# The marker holds the folder and the checksum of pyproject.toml; if either changed, the project is installed again.
install_project() {
    marker=.venv/installed-$1
    wanted="$PWD $(cksum <pyproject.toml)"
    if ! $bin/python -c 'import pip' 2>/dev/null; then
        make_venv
    elif [ "$(cat "$marker" 2>/dev/null)" = "$wanted" ]; then
        return
    fi
    echo "Installing akap-editor in .venv; this takes a minute or two the first time."
    pip_install "$2" || { echo "pip failed, trying once more." && pip_install "$2"; }
    echo "$wanted" >"$marker"
}

packages=$(missing_packages)
if [ -n "$packages" ]; then
    # shellcheck disable=SC2086  # one word per package
    if ! install_packages $packages; then
        [ "$purpose" = run ] || exit 1
        echo "Continuing without them." >&2
    fi
fi
if [ "$purpose" = run ]; then install_project run .; else install_project dev ".[dev]"; fi
