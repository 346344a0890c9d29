"""Runs inside Blender: opens a BVH or glTF file and tells where everything is, frame by frame.

usage: blender -b -P in_blender.py -- FILE OUT.json
"""

import builtins
import json
import pathlib
import sys

import bpy

PATH, OUT = sys.argv[sys.argv.index("--") + 1:]
# Debian 12 has a Blender whose BVH reader opens files as "rU", which its Python no longer knows.
plain_open = builtins.open
builtins.open = lambda file, mode="r", *rest, **more: plain_open(file, mode.replace("U", ""), *rest, **more)

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
if PATH.endswith(".bvh"):
    # Without turning y up into z up.
    bpy.ops.import_anim.bvh(filepath=PATH, axis_forward="Y", axis_up="Z", rotate_mode="NATIVE",
                            update_scene_fps=True, update_scene_duration=True)
else:
    bpy.ops.import_scene.gltf(filepath=PATH)
ranges = [action.frame_range for action in bpy.data.actions]
begin, end = int(min(r[0] for r in ranges)), int(max(r[1] for r in ranges))
places = []
for frame in range(begin, end + 1):
    scene.frame_set(frame)
    row = {}
    for thing in scene.objects:
        row[thing.name] = list(thing.matrix_world.translation)
        if thing.type == "ARMATURE":
            row = {bone.name: list(thing.matrix_world @ bone.head) for bone in thing.pose.bones}
    places.append(row)
pathlib.Path(OUT).write_text(json.dumps({"rate": scene.render.fps / scene.render.fps_base, "places": places}))
