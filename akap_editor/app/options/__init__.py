"""The bar over the top of the canvas: what the current tool offers."""
