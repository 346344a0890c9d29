// The embedded numbers as arrays, and values at any time.

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}

function int16Of(base64) {
  return new Int16Array(bytesOf(base64).buffer);  // little-endian, as every browser's machine is
}

function restore({ offset, scale, numbers }) {
  return Float32Array.from(int16Of(numbers), (number) => offset + scale * number);
}

// The frames before and after `time`, and how far it lies between them.
function between(motion, time) {
  const at = Math.min(Math.max(time * motion.rate, 0), motion.frames - 1);
  const before = Math.floor(at);
  return { before, after: Math.min(before + 1, motion.frames - 1), share: at - before };
}

// Points of a body or a face in time: x and y relative to the neck, y down.
class Figure {
  constructor({ names, parents, sources, ...packed }) {
    this.names = names;
    this.parents = parents;
    this.sources = sources;
    this.values = restore(packed);
    this.byName = new Map(names.map((name, point) => [name, point]));
    this.bySource = new Map(sources.map((source, point) => [source, point]));
  }

  point(frame, point) {
    const n = this.names.length, row = 2 * n * frame;
    return [this.values[row + point], this.values[row + n + point]];
  }

  // All points at a time of `motion`, as [x, y].
  at(motion, time) {
    const { before, after, share } = between(motion, time);
    return this.names.map((_, point) => {
      const [ax, ay] = this.point(before, point), [bx, by] = this.point(after, point);
      return [ax + share * (bx - ax), ay + share * (by - ay)];
    });
  }
}

// One curve in time, an action unit or an angle.
class Curve {
  constructor({ name, unit, minimum, maximum, ...packed }) {
    Object.assign(this, { name, unit, minimum, maximum });
    this.values = restore(packed);
  }

  at(motion, time) {
    const { before, after, share } = between(motion, time);
    return this.values[before] + share * (this.values[after] - this.values[before]);
  }
}

function motionOf(take) {
  const motion = { ...take, label: take.role[0].toUpperCase() + take.role.slice(1) };
  if (take.body) motion.body = new Figure(take.body);
  if (take.face) motion.face = new Figure(take.face);
  if (take.curves) motion.curves = take.curves.map((curve) => new Curve(curve));
  if (motion.body) motion.shoulder = shoulderOf(motion);
  return motion;
}

// The usual length from neck to right shoulder, in the figure's unit.
function shoulderOf({ body, frames }) {
  const shoulder = body.byName.get("RShoulder"), neck = body.byName.get("Neck");
  if (shoulder === undefined || neck === undefined) return 167;
  const lengths = Float32Array.from({ length: frames }, (_, frame) => {
    const [x, y] = body.point(frame, shoulder), [nx, ny] = body.point(frame, neck);
    return Math.hypot(x - nx, y - ny);
  }).sort();
  return lengths[frames >> 1] || 167;
}

// How fast a point moves at each frame, per second, by the difference of its neighbours in time.
function speedOf({ body, frames, rate }, point) {
  return Float32Array.from({ length: frames }, (_, frame) => {
    const before = Math.max(frame - 1, 0), after = Math.min(frame + 1, frames - 1);
    if (after === before) return 0;
    const [ax, ay] = body.point(before, point), [bx, by] = body.point(after, point);
    return Math.hypot(bx - ax, by - ay) * rate / (after - before);
  });
}

// The word that is spoken at `time`, or -1.  Words are sorted and do not overlap.
function wordAt(words, time) {
  let low = 0, high = words.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (words[middle][1] <= time) low = middle + 1; else high = middle;
  }
  return low > 0 && time < words[low - 1][2] ? low - 1 : -1;
}

function readShow() {
  const show = JSON.parse(document.getElementById("data").textContent);
  show.takes = show.takes.map(motionOf);
  show.prediction = show.takes.find((take) => take.role === "prediction");
  if (show.levels) {
    show.levels.peak = bytesOf(show.levels.peak);
    show.levels.rms = bytesOf(show.levels.rms);
  }
  if (show.spectrogram) show.spectrogram.values = bytesOf(show.spectrogram.values);
  if (show.pitch) show.pitch.hz = Float32Array.from(int16Of(show.pitch.tenths), (tenths) => tenths / 10);
  return show;
}
