// ONNX Runtime's end of the pipe (workers.py): ort_worker.js NODE_MODULES FOLDER MODEL.onnx THREADS.
'use strict';

const fs = require('fs');
const path = require('path');
const readline = require('readline');

const [modules, folder, model, threads] = process.argv.slice(2);
const ort = require(path.join(path.resolve(modules), 'onnxruntime-node'));

const OPTIONS = {
  executionProviders: ['cpu'],
  graphOptimizationLevel: 'all',
  executionMode: 'sequential',
  intraOpNumThreads: Number(threads),
  interOpNumThreads: 1,
  extra: {session: {intra_op: {allow_spinning: '0'}, inter_op: {allow_spinning: '0'}}},
};
const ARRAYS = {float32: Float32Array, int32: Int32Array};

function readInputs() {
  const feeds = {};
  const described = JSON.parse(fs.readFileSync(path.join(folder, 'case.json'), 'utf8')).inputs;
  for (const [name, {shape, type}] of Object.entries(described)) {
    const bytes = fs.readFileSync(path.join(folder, name + '.bin'));
    const values = new ARRAYS[type](new Uint8Array(bytes).buffer);
    feeds[name] = new ort.Tensor(type, values, shape);
  }
  return feeds;
}

async function main() {
  const feeds = readInputs();
  const session = await ort.InferenceSession.create(model, OPTIONS);
  let outputs = await session.run(feeds);
  console.log('ready');
  for await (const line of readline.createInterface({input: process.stdin})) {
    const at = line.indexOf(' ');
    const request = line.slice(0, at), argument = line.slice(at + 1);
    if (request === 'run') {
      const times = [];
      for (let n = Number(argument); n > 0; --n) {
        const start = process.hrtime.bigint();
        outputs = await session.run(feeds);
        times.push(process.hrtime.bigint() - start);
      }
      console.log(times.join(' '));
    } else {
      const parts = session.outputNames.map((name) => Buffer.from(
          outputs[name].data.buffer, outputs[name].data.byteOffset, outputs[name].data.byteLength));
      fs.writeFileSync(argument, Buffer.concat(parts));
      console.log('written');
    }
  }
}

main().catch((error) => {
  console.error('ort_worker: ' + error.message.split('\n')[0]);
  process.exit(1);
});
