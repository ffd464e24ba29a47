"""Which layers of a drawing are shown, and in which order; and slots, of whose layers one is shown."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from .drawing_layer import DrawingLayer
from .layered_picture import Layer


@dataclass(frozen=True)
class LayerView:
    """What a keyframe holds of the layer list.

    visible: (l,) whether the eye of each layer is open; order: the numbers of the layers from back to front.
    """

    visible: tuple[bool, ...]
    order: tuple[int, ...]

    def fits(self, count: int) -> bool:
        """Whether it is one of ``count`` layers."""
        return len(self.visible) == count and sorted(self.order) == list(range(count))


def with_one_shown(
    layers: Sequence[DrawingLayer], order: Sequence[int], preferred: Collection[int] = ()
) -> tuple[DrawingLayer, ...]:
    """Layers of which at most one in each slot is visible: a preferred one, else the foremost.

    order: the numbers of the layers from back to front.
    """
    taken: set[str] = set()
    result = list(layers)
    front_first = [*reversed(order)]
    for number in sorted(front_first, key=lambda number: number not in preferred):
        layer = layers[number]
        if layer.slot and layer.visible:
            if layer.slot in taken:
                result[number] = replace(layer, visible=False)
            taken.add(layer.slot)
    return tuple(result)


def view_with_one_shown(view: LayerView, layers: Sequence[DrawingLayer]) -> LayerView:
    """A view in which at most one layer of each slot of ``layers`` is visible."""
    seen = [replace(layer, visible=on) for layer, on in zip(layers, view.visible, strict=True)]
    return replace(view, visible=tuple(layer.visible for layer in with_one_shown(seen, view.order)))


def group_slots(layers: Sequence[Layer]) -> list[str]:
    """The slot of each layer of a picture that was just opened, empty for none.

    Artists draw mouths in one group, of which one is visible: a group without further ones inside, of two
    layers or more of which exactly one is visible, is a slot of its name.
    """
    members: dict[int, list[int]] = {}
    inner = {id(group) for layer in layers for group in layer.groups[:-1]}
    for number, layer in enumerate(layers):
        if layer.groups and id(layer.groups[-1]) not in inner:
            members.setdefault(id(layer.groups[-1]), []).append(number)
    slots = [""] * len(layers)
    for numbers in members.values():
        if len(numbers) > 1 and sum(layers[number].visible for number in numbers) == 1:
            for number in numbers:
                slots[number] = layers[number].groups[-1].name
    return slots


def slot_members(layers: Sequence[DrawingLayer]) -> dict[str, list[int]]:
    """The numbers of the layers in each slot, by its name, in the order of the layers."""
    members: dict[str, list[int]] = {}
    for number, layer in enumerate(layers):
        if layer.slot:
            members.setdefault(layer.slot, []).append(number)
    return members


def unused_slot_name(layers: Sequence[DrawingLayer], members: Sequence[int]) -> str:
    """A name for a new slot: what the names of its layers begin with, else "Slot" and a number."""
    used = {layer.slot for layer in layers}
    names = [layers[number].name for number in members]
    words = [name.replace("_", " ").replace("-", " ").split() for name in names]
    common = []
    for each in zip(*words, strict=False):
        if len({word.lower() for word in each}) > 1:
            break
        common.append(each[0])
    name = " ".join(common)
    if name and name not in used:
        return name
    return next(name for k in range(1, len(used) + 2) if (name := f"Slot {k}") not in used)
