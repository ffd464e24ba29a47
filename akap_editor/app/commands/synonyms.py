"""Words of other programs by which the palette finds commands."""

SYNONYMS = {
    "Open": "import load picture image",
    "Cut Out with Mask": "matte background remove alpha",
    "Reload Artwork": "refresh update replace picture footage psd linked",
    "Merge Layers": "flatten image combine",
    "Save Recording": "record session macro",
    "Export": "export png svg gltf obj spine image picture render save for web",
    "Export Animation": "export gif video mp4 webm movie webp apng render sprite sheet frames",
    "Undo": "step back revert",
    "Redo": "step forward repeat",
    "Paste Picture or Pose": "clipboard insert open",
    "Copy as Picture": "clipboard screenshot image png",
    "Copy Pose": "clipboard pins",
    "Remove Selected Pins": "delete clear",
    "Deselect": "select none",
    "Pin Values": "coordinates position numbers transform",
    "Pin Tool": "puppet warp deform bend liquify mesh move",
    "Joint Tool": "brad bone rig hinge weld layers skeleton",
    "Hand Tool": "pan scroll move view",
    "Zoom Tool": "magnify magnifying glass loupe",
    "Stiffness Brush": "starch rigid freeze paint stick bone mask",
    "Hold Angle": "rotate lock fix",
    "Bring Limb to Front": "overlap order depth arrange layer forward",
    "Send Limb to Back": "overlap order depth arrange layer backward",
    "Raise Depth": "overlap front z order",
    "Lower Depth": "overlap back z order",
    "Reset Pose": "original default unbend undo all rest",
    "Set Rest Pose from Current": "apply bake freeze transform",
    "Remember Rest Shape": "smooth elastic spring back memory soft",
    "Reset Parameters": "default settings smooth",
    "Show Mesh": "wireframe triangles grid lines puppet warp",
    "Show Area Distortion": "heat map scale size stretch",
    "Show Angle Distortion": "heat map shear stretch",
    "Show Rest Pose": "ghost original before",
    "Show Pin Trails": "path motion trajectory",
    "Show Checkerboard": "transparency grid background",
    "Reference Picture": "template trace background rotoscope",
    "Compare Methods": "split side by side arap smooth",
    "Show Timeline": "animation keyframes dope sheet",
    "Hide Panels": "distraction free canvas only",
    "Full Screen": "maximize presentation",
    "Fit in Window": "zoom all view everything reset",
    "Actual Size": "100 % zoom pixels",
    "Play": "preview animate run spacebar",
    "Add Keyframe": "key insert animate pose",
    "Onion Skin": "ghost frames light table",
    "Preferences": "settings options hotkeys shortcuts keyboard bindings customize",
    "Keyboard Shortcuts": "hotkeys bindings keys help cheat sheet",
    "Find Command": "search palette help",
}


def has_synonym(query: str, name: str) -> bool:
    """Whether each word of the query begins a word of the synonyms or of the name itself."""
    words = f"{name} {SYNONYMS.get(name, '')}".lower().split()
    typed = query.lower().split()
    return bool(typed) and all(any(word.startswith(part) for word in words) for part in typed)
