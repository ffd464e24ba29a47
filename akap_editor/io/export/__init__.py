"""Exports drawings for other programs, as docs/exporting.md describes: pictures, outlines, meshes."""

from .formats import EXPORT_FORMATS, ExportFormat, ExportOptions, export, format_of, replaced_companions

__all__ = ["EXPORT_FORMATS", "ExportFormat", "ExportOptions", "export", "format_of", "replaced_companions"]
