"""Reduces the layers of a file to layers that can move on their own."""

from .composite import Node, arrange, node_picture
from .layered_picture import PASS_THROUGH, Layer, LayeredPicture, LayerGroup

_PLAIN = (PASS_THROUGH, "normal")


def movable_layers(layered: LayeredPicture) -> list[Layer]:
    """The layers of a picture that can move on their own, from the bottom to the top.

    What is clipped to a layer or group is merged into it, because it must not leave it; a group that is
    blended as a whole becomes one layer. The other groups only pass on their opacity and whether they are
    visible. Layers of which nothing is left are dropped.
    """
    result: list[Layer] = []

    def walk(nodes: list[Node], groups: tuple[LayerGroup, ...]) -> None:
        for node in nodes:
            content = node.content
            if node.clipped or (isinstance(content, LayerGroup) and content.blend not in _PLAIN):
                merged = node_picture(node)
                if merged is not None:
                    blend = "normal" if content.blend == PASS_THROUGH else content.blend
                    whole = Layer(content.name, *merged, groups, content.opacity, blend, content.visible)
                    result.append(_alone(whole))
            elif isinstance(content, LayerGroup):
                walk(node.children, (*groups, content))
            elif content.picture[..., 3].any():
                result.append(_alone(content))

    walk(arrange(layered.layers), ())
    return result


def _alone(layer: Layer) -> Layer:
    """A layer with the opacity and visibility of its groups."""
    opacity = layer.opacity
    for group in layer.groups:
        opacity *= group.opacity
    return Layer(layer.name, layer.picture, layer.offset, layer.groups, opacity, layer.blend, layer.is_shown)
