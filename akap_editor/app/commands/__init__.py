"""Commands and the ways to run one: menus, keys, the palette and the page of shortcuts."""
