"""What makes the program known to a desktop: menu entry, file types, icons, thumbnails."""
