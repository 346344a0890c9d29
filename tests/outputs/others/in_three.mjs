// Opens a BVH or VRM Animation file with three.js and pixiv's loader, and prints as JSON what it found.
//
// usage: node in_three.mjs FILE
import fs from "node:fs";
import * as THREE from "three";
import { BVHLoader } from "three/examples/jsm/loaders/BVHLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { VRMAnimationLoaderPlugin } from "@pixiv/three-vrm-animation";

globalThis.self = globalThis;  // which the loader of glTF expects

const path = process.argv[2], bytes = fs.readFileSync(path);

function placesOf(bvh) {
  const root = bvh.skeleton.bones[0], mixer = new THREE.AnimationMixer(root), frames = [];
  mixer.clipAction(bvh.clip).play();
  for (const time of bvh.clip.tracks[0].times) {
    mixer.setTime(Math.min(time, bvh.clip.duration - 1e-6));  // a player goes round at its end
    root.updateMatrixWorld(true);
    const place = (bone) => [bone.name, bone.getWorldPosition(new THREE.Vector3()).toArray()];
    frames.push(Object.fromEntries(bvh.skeleton.bones.map(place)));
  }
  return frames;
}

function tracksOf(gltf) {
  const [animation] = gltf.userData.vrmAnimations, values = (track) => Array.from(track.values);
  const all = (tracks) => Object.fromEntries([...tracks].map(([name, track]) => [name, values(track)]));
  return { rotations: all(animation.humanoidTracks.rotation), custom: all(animation.expressionTracks.custom),
           seconds: animation.duration };
}

if (path.endsWith(".bvh")) {
  console.log(JSON.stringify(placesOf(new BVHLoader().parse(bytes.toString()))));
} else {
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  loader.parse(buffer, "", (gltf) => console.log(JSON.stringify(tracksOf(gltf))), (error) => { throw error; });
}
