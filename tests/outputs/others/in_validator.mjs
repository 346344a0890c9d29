// Prints what Khronos' glTF validator has to say of files, as JSON.
//
// usage: node in_validator.mjs FILE
import fs from "node:fs";
import validator from "gltf-validator";

const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])));
console.log(JSON.stringify(report.issues));
