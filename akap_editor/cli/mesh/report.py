"""Texts about the meshes that the command `mesh` has made."""

import numpy as np

from ...display_text import display_text
from ...io.open_document import MIN_REPORTED_SHARE, faint_note
from .measures import MeshRow


def description(row: MeshRow) -> str:
    """Several lines about one mesh."""
    lines = [
        f"{display_text(row.picture)}: {_count_noun(row.parts, 'part')}, {_count_noun(row.holes, 'hole')}, "
        f"{row.vertices} vertices, {row.faces} faces",
        f"  smallest angle  {row.worst_angle:.1f}°, 1st percentile {row.low_angle:.1f}°",
        f"  covered         {row.covered:.2%} of the visible area; {row.outside:.1%} of the mesh is outside",
        f"  time            {row.seconds:.3f} s",
    ]
    width = max((len(layer.name) for layer in row.layers), default=0)
    lines += [
        f"  {display_text(layer.name):<{width}}  {layer.quality.vertices:>6} vertices, smallest angle "
        f"{layer.quality.worst_angle:4.1f}°, covered {layer.quality.covered:7.2%}, "
        f"{layer.quality.outside:6.1%} outside"
        for layer in row.layers
    ]
    lines += [f"  {note}" for note in row.notes]
    if row.faint >= MIN_REPORTED_SHARE:
        lines.append(f"  {faint_note(row.faint)}")
    if row.specks:
        lines.append(
            f"  left out        {_count_noun(row.specks, 'speck')}, {row.speck_share:.2%} of the visible area"
        )
    if not row.cut_out:
        lines.append("  The picture has no transparency, so the mesh is a rectangle; use --mask.")
    if row.mesh is not None:
        lines.append(f"Wrote {display_text(row.mesh)}")
    return "\n".join(lines)


def _count_noun(count: int, noun: str, plural: str = "") -> str:
    """E.g. "1 part" or "2 parts"; plural: of the noun if it is irregular."""
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def table(rows: list[MeshRow], failed: int) -> list[str]:
    """One line per picture, and a summary."""
    names = [display_text(row.picture) for row in rows]
    width = max(map(len, ["picture", *names]))
    lines = [
        f"{'picture':<{width}} {'parts':>6} {'holes':>6} {'specks':>7} {'vertices':>9} {'faces':>7}"
        f" {'1 % angle':>10} {'worst':>6} {'covered':>8} {'outside':>8} {'seconds':>8}"
    ]
    lines += [
        f"{name:<{width}} {row.parts:>6} {row.holes:>6} {row.specks:>7} {row.vertices:>9}"
        f" {row.faces:>7} {row.low_angle:>9.1f}° {row.worst_angle:>5.1f}° {row.covered:>8.2%}"
        f" {row.outside:>8.1%} {row.seconds:>8.3f}"
        for name, row in zip(names, rows, strict=True)
    ]
    if rows:
        seconds = [row.seconds for row in rows]
        worst, least = (
            min(row.worst_angle for row in rows),
            min(row.covered for row in rows),
        )
        lines.append(
            f"{_count_noun(len(rows), 'mesh', 'meshes')}, {failed} failed; "
            f"median {np.median(seconds):.3f} s, slowest {max(seconds):.3f} s; "
            f"worst angle {worst:.1f}°, least covered {least:.2%}"
        )
    else:
        lines.append(f"0 meshes, {failed} failed")
    return lines
