"""Words of other programs by which the palette finds commands."""

from ...words import mark, tr

SYNONYMS = {
    "Open": mark("import load picture image"),
    "Cut Out with Mask": mark("matte background remove alpha"),
    "Reload Artwork": mark("refresh update replace picture footage psd linked"),
    "Merge Layers": mark("flatten image combine"),
    "Save Recording": mark("record session macro"),
    "Export": mark("export png svg gltf obj spine image picture render save for web"),
    "Export Animation": mark("export gif video mp4 webm movie webp apng render sprite sheet frames"),
    "Undo": mark("step back revert"),
    "Redo": mark("step forward repeat"),
    "Paste Picture or Pose": mark("clipboard insert open"),
    "Copy as Picture": mark("clipboard screenshot image png"),
    "Copy Pose": mark("clipboard pins"),
    "Remove Selected Pins": mark("delete clear"),
    "Suggest Pins": mark("auto rig automatic joints skeleton propose place pins"),
    "Deselect": mark("select none"),
    "Align Left": mark("arrange line up pins"),
    "Mirror Pins": mark("symmetry symmetric x-axis both sides"),
    "Draw Mirror Axis": mark("symmetry line"),
    "Pair Pins": mark("link symmetry partner"),
    "Flip Pose": mark("mirror horizontal left right reverse x-flip"),
    "Pin Values": mark("coordinates position numbers transform"),
    "Pin Tool": mark("puppet warp deform bend liquify mesh move"),
    "Joint Tool": mark("brad bone rig hinge weld layers skeleton"),
    "Knife": mark("cut slit split separate scissors apart tear"),
    "Hand Tool": mark("pan scroll move view"),
    "Zoom Tool": mark("magnify magnifying glass loupe"),
    "Stiffness Brush": mark("starch rigid freeze paint stick bone mask"),
    "Hold Angle": mark("rotate lock fix"),
    "Bring Limb to Front": mark("overlap order depth arrange layer forward"),
    "Send Limb to Back": mark("overlap order depth arrange layer backward"),
    "Raise Depth": mark("overlap front z order"),
    "Lower Depth": mark("overlap back z order"),
    "Reset Pose": mark("original default unbend undo all rest"),
    "Set Rest Pose from Current": mark("apply bake freeze transform"),
    "Remember Rest Shape": mark("smooth elastic spring back memory soft"),
    "Reset Parameters": mark("default settings smooth"),
    "Show Mesh": mark("wireframe triangles grid lines puppet warp"),
    "Show Area Distortion": mark("heat map scale size stretch"),
    "Show Angle Distortion": mark("heat map shear stretch"),
    "Show Rest Pose": mark("ghost original before"),
    "Show Pin Trails": mark("path motion trajectory"),
    "Show Checkerboard": mark("transparency grid background"),
    "Reference Picture": mark("template trace background rotoscope"),
    "Compare Methods": mark("split side by side arap smooth"),
    "Show Timeline": mark("animation keyframes dope sheet"),
    "Hide Panels": mark("distraction free canvas only"),
    "Full Screen": mark("maximize presentation"),
    "Fit in Window": mark("zoom all view everything reset"),
    "Actual Size": mark("100 % zoom pixels"),
    "Play": mark("preview animate run spacebar"),
    "Add Keyframe": mark("key insert animate pose"),
    "Speed Graph": mark("curve editor graph editor velocity easing handles"),
    "Onion Skin": mark("ghost frames light table"),
    "Preferences": mark("settings options hotkeys shortcuts keyboard bindings customize"),
    "Keyboard Shortcuts": mark("hotkeys bindings keys help cheat sheet"),
    "Find Command": mark("search palette help"),
}


def has_synonym(query: str, label: str, english: str = "") -> bool:
    """Whether each word of the query begins a word of a label or of its synonyms, in English, too."""
    synonyms = SYNONYMS.get(english or label, "")
    words = f"{label} {english} {synonyms} {tr(synonyms)}".lower().split()
    typed = query.lower().split()
    return bool(typed) and all(any(word.startswith(part) for word in words) for part in typed)
