#!/bin/sh
# Builds dist/akap-editor, a folder (on macOS an app) that runs without Python, and packs it: as an AppImage where
# appimagetool is installed, else as .tar.gz or .zip. PYTHON names the Python to use.
set -eu
cd "$(dirname "$0")/../.."
venv=build/bundle-venv
[ -d "$venv" ] || "${PYTHON:-python3}" -m venv "$venv"
if [ -d "$venv/Scripts" ]; then bin=$venv/Scripts; else bin=$venv/bin; fi
"$bin/python" -m pip --quiet --disable-pip-version-check install '.[video]' 'pyinstaller>=6.10,<7' pillow
"$bin/python" -m PyInstaller --noconfirm --log-level WARN --distpath dist --workpath build/bundle tools/bundle/akap-editor.spec
system=$(uname -s)-$(uname -m)
case $system in
Linux-*)
    if command -v appimagetool >/dev/null; then
        sh tools/bundle/appimage.sh
    else
        tar -C dist -czf "dist/akap-editor-$system.tar.gz" akap-editor
    fi
    ;;
Darwin-*) (cd dist && zip -qry "akap-editor-$system.zip" akap-editor.app) ;;
*) "$bin/python" -m zipfile -c dist/akap-editor-windows.zip dist/akap-editor ;;
esac
du -sh dist/akap-editor
