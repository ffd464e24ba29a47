"""Commands, and every way to run one: keys, menus and the palette."""
