"""The frame around the canvas: menus, options bar, toolbar, side panel, timeline and status bar."""
