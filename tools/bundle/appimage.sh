#!/bin/sh
# Packs dist/akap-editor as an AppImage; needs appimagetool.
set -eu
cd "$(dirname "$0")/../.."
root=build/akap-editor.AppDir
rm -rf "$root"
mkdir -p "$root/usr/share/metainfo"
cp -a dist/akap-editor "$root/usr/bin"
cp assets/desktop/akap-editor.desktop "$root/"
cp assets/desktop/akap-editor.metainfo.xml "$root/usr/share/metainfo/"
cp assets/icons/akap-editor-256.png "$root/akap-editor.png"
ln -sf usr/bin/akap-editor "$root/AppRun"
appimagetool "$root" "dist/akap-editor-$(uname -m).AppImage"
